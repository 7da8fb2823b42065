/* What acts over time: each input is a line and a sine of the time.
 *
 * level + slope * (t - start) + amplitude * sin(2 pi (frequency * t + phase)), phase in turns, `start` that of the
 * piece of time. The phase is exact to a microturn after 10^9 turns: the product of frequency and time is taken
 * without rounding, and its whole turns are left out, once a step.
 */
#ifndef DELAGRANGE_DRIVES_H
#define DELAGRANGE_DRIVES_H

#include "model.h"
#include "sine.h"

/* The numbers of the drives of WIDTH runs, and where their piece of time begins [s]. */
typedef struct {
    vec level[INPUT_ROWS], slope[INPUT_ROWS], amplitude[INPUT_ROWS], frequency[INPUT_ROWS], phase[INPUT_ROWS], start;
} Drives;

/* Where each drive is at the start of a step, and its change over the step: half turns of the sine, and the line. */
typedef struct {
    vec turns[INPUT_ROWS], turns_step[INPUT_ROWS], line[INPUT_ROWS], line_step[INPUT_ROWS];
} Course;

/* What rounding took from a product. Where the processor does not fuse, Dekker (1971), Numer. Math. 18, 224, Sec. 5. */
INLINE vec rounded_off(vec a, vec b, vec product)
{
#if FUSES
    return madd(a, b, -product);
#else
    vec rest = 134217729.0 * a, a_high = rest - (rest - a), a_low = a - a_high;
    rest = 134217729.0 * b;
    vec b_high = rest - (rest - b), b_low = b - b_high;
    return (((a_high * b_high - product) + a_high * b_low) + a_low * b_high) + a_low * b_low;
#endif
}

/* frequency * time without its whole turns. */
INLINE vec turns_of(vec frequency, vec time)
{
    vec product = frequency * time;
    return (product - whole(product)) + rounded_off(frequency, time, product);
}

/* A step from `time` + `since`, which may lie closer to the start of the step than one number can tell. */
INLINE void begin_course(const Drives *drives, vec time, vec since, vec step, Course *course)
{
    UNROLLED for (int i = 0; i < INPUTS; i++) {
        vec frequency = drives->frequency[i], before = (time - drives->start) + since;
        vec turns = (turns_of(frequency, time) + turns_of(frequency, since)) + drives->phase[i];
        course->turns[i] = turns + turns;
        course->turns_step[i] = (frequency + frequency) * step;
        course->line[i] = madd(drives->slope[i], before, drives->level[i]);
        course->line_step[i] = drives->slope[i] * step;
    }
}

/* The inputs at a node of the step, 0 at its start and 1 at its end; `vibrates` says which of them have a sine. */
INLINE void inputs_at(double node, const Drives *const *drives, const Course *const *course, const uint8_t *vibrates,
                      vec (*input)[INPUT_ROWS])
{
    UNROLLED for (int i = 0; i < INPUTS; i++) {
        EACH input[v][i] = maddc(node, course[v]->line_step[i], course[v]->line[i]);
        if (vibrates[i]) {
            VALUE(swing) = maddc(node, course[v]->turns_step[i], course[v]->turns[i]);
            sine(swing);
            EACH input[v][i] = madd(drives[v]->amplitude[i], swing[v], input[v][i]);
        }
    }
}

#endif
