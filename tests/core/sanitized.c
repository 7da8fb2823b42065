/* Every entry of the core with arrays of their exact sizes, for sanitizers: prints three statuses. */
#include "delagrange.h"
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RUNS = 37, PIECES = 2, SAMPLES = 5, TIMES = 4, COLUMNS = STATES + 2 };
static double *filled(int count, double value)
{
    double *array = malloc(count * sizeof(double));
    for (int n = 0; n < count; n++) array[n] = value;
    return array;
}

int main(void)
{
    double parameter[PARAMETERS] = {5e-3, 1e-3, 1.2e3, 6.198e-11, 1.8e4, 4.2e4, 40.0}, rest[STATES];
    for (int i = 7; i < PARAMETERS; i++) parameter[i] = 1.5;
    reference(parameter, rest);
    double *state = filled(STATES * RUNS, 1.0), *drives = filled(PIECES * 5 * INPUTS * RUNS, 0.0);
    double *atol = filled(STATES, 1e-10), pieces[] = {0.0, 1e-3, 0.0, 1e-3, 4e-3, 1.0};
    for (int i = 0; i < STATES; i++) for (int r = 0; r < RUNS; r++) state[i * RUNS + r] = rest[i];
    state[5] = NAN;
    for (int piece = 0; piece < PIECES; piece++) for (int r = 0; r < RUNS; r++) {
        double *own = drives + piece * 5 * INPUTS * RUNS + r;
        own[0] = 0.3, own[RUNS] = 1e5 * r * r, own[(2 * INPUTS + 1) * RUNS] = 3e6 * (r % 9);
        for (int i = 0; i < INPUTS; i++) own[(3 * INPUTS + i) * RUNS] = 300.0 + 20.0 * r;
    }
    double *parameters = filled(PARAMETERS, 0.0), *first = filled(RUNS, 0.0), *spacing = filled(RUNS, 1e-3);
    for (int i = 0; i < PARAMETERS; i++) parameters[i] = parameter[i];
    int64_t *whole = malloc(3 * RUNS * sizeof(int64_t));
    for (int n = 0; n < 3 * RUNS; n++) whole[n] = DELAGRANGE_INTERRUPTED;
    double *measures[4], *samples = filled(SAMPLES * STATES * RUNS, NAN), *last = filled(STATES * RUNS, NAN);
    for (int n = 0; n < 4; n++) measures[n] = filled(COORDINATES * RUNS, n == 0 ? -INFINITY : INFINITY);
    double *ended = filled(RUNS, 0.0), progress;
    delagrange_runs runs = {RUNS, parameters, 1, state, pieces, drives, PIECES, RUNS, 1e-6, atol, 0.2, 2.2, 1, SAMPLES,
        first, spacing, samples, measures[0], measures[1], measures[2], measures[3], last, whole, ended, whole + RUNS,
        whole + 2 * RUNS, NULL};
    void *room = malloc(delagrange_lanes_workspace());
    delagrange_integrate(&runs, 0, RUNS, &progress, room);
    free(room);

    double *times = filled(TIMES, 0.0), *states = filled(TIMES * STATES, NAN), *one = filled(STATES, NAN);
    double *lone = filled(PIECES * 5 * INPUTS, 0.0), *energy = filled(TIMES * ENERGIES, NAN);
    for (int n = 0; n < TIMES; n++) times[n] = n * 4e-3 / (TIMES - 1);
    lone[0] = lone[5 * INPUTS] = 0.3, lone[3 * INPUTS - 1] = 2e6, lone[4 * INPUTS - 1] = 300.0;
    delagrange_run run = {0, parameters, rest, pieces, lone, PIECES, 1e-9, atol, 1e-3, 100.0, TIMES, times, states, energy,
        one, DELAGRANGE_INTERRUPTED, 0.0, 0, 0};
    room = malloc(delagrange_trajectory_workspace());
    while (run.status == DELAGRANGE_INTERRUPTED) delagrange_trajectory(&run, 7, room);
    free(room);

    double *columns = filled(COLUMNS * STATES, 0.0), *weights = filled(STATES, 1.0), *divergence = filled(TIMES, NAN);
    double *growth = filled((TIMES - 1) * COLUMNS, NAN), *high = filled(COORDINATES, 1.0), *low = filled(COORDINATES, 1.0);
    double *gone = filled(COLUMNS * STATES, NAN);
    int64_t *sources = malloc(2 * COLUMNS * sizeof(int64_t));
    for (int n = 0; n < 2 * COLUMNS; n++) sources[n] = -1;
    for (int n = 0; n < STATES; n++) columns[n * STATES + n] = 1.0, states[n] = rest[n];
    sources[2 * STATES] = INPUTS - 1, sources[2 * STATES + 1] = DELAGRANGE_FREQUENCY, divergence[0] = 0.0;
    delagrange_tangent tangent = {0, parameters, rest, lone, 0.0, weights, 1e-9, 1e-3, 100.0, TIMES, times, COLUMNS, columns,
        sources, 0, states, growth, divergence, high, low, one, gone, DELAGRANGE_INTERRUPTED, 0.0, 0, 0};
    room = malloc(delagrange_tangents_workspace(COLUMNS));
    while (tangent.status == DELAGRANGE_INTERRUPTED) delagrange_travel(&tangent, 5, room);
    tangent.begun = 0, tangent.status = DELAGRANGE_INTERRUPTED, tangent.normalise = 1, tangent.column_count = STATES;
    while (tangent.status == DELAGRANGE_INTERRUPTED) delagrange_travel(&tangent, 5, room);
    free(room);
    printf("%d %d %d", (int)whole[1], (int)run.status, (int)tangent.status);
    double *all_arrays[] = {state, drives, atol, parameters, first, spacing, samples, last, ended, times, states, one, lone,
        energy, columns, weights, divergence, growth, high, low, gone, measures[0], measures[1], measures[2], measures[3]};
    for (unsigned n = 0; n < sizeof all_arrays / sizeof *all_arrays; n++) free(all_arrays[n]);
    free(whole), free(sources);
    return 0;
}
