/* One run of the membrane of Sheng et al. (2015) in C, without Python: `make c-example`.
 *
 * Prints time [s] and stretch [1]. What the fields mean is said in src/delagrange/core/c/delagrange.h, the order of state,
 * inputs and parameters in generated/equal_biaxial.h.
 */
#include "delagrange.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int main(void)
{
    double parameters[] = {5e-3, 1e-3, 1.2e3, 6.198e-11, 1.8e4, 4.2e4, 400.0 * 4.2e4};
    double state[] = {1.0, 0.0, 1.0}, pieces[] = {0.0, 0.01, 1.0}, atol[] = {1e-12, 1e-12, 1e-12};
    double drives[] = {0.2, 0.0, 0.0, 0.0, 0.0, 1e6, 0.0, 300.0, 0.0, 0.0}; /* rows: level, slope, amplitude, ... */
    double times[] = {0.0, 0.005, 0.01}, states[9], last[3];
    delagrange_run run = {.parameters = parameters, .state = state, .pieces = pieces, .drives = drives,
        .piece_count = 1, .rtol = 1e-9, .atol = atol, .smallest = 1e-3, .largest = 100.0, .time_count = 3,
        .times = times, .states = states, .last_state = last, .status = DELAGRANGE_INTERRUPTED};
    void *workspace = malloc(delagrange_trajectory_workspace());
    while (run.status == DELAGRANGE_INTERRUPTED) delagrange_trajectory(&run, 1000, workspace);
    for (int row = 0; row < 3; row++) printf("%.17g %.17g\n", times[row], states[3 * row]);
    free(workspace);
    return run.status != DELAGRANGE_COMPLETED;
}
