/* The stages of a step: state, inputs and rates of each, for one row of packs after the other. */
#ifndef DELAGRANGE_STAGES_H
#define DELAGRANGE_STAGES_H

#include "pack.h"

/* The packs p, p + 1, ... as the equations and the drives want them: ABREAST at a time. */
typedef struct {
    const Drives *drives[ABREAST];
    const Course *course[ABREAST];
    const vec *constant[ABREAST];
} Row;

INLINE Row row_of(Pack *p)
{
    Row row;
    EACH row.drives[v] = &p[v].drives, row.course[v] = &p[v].course, row.constant[v] = p[v].constant;
    return row;
}

INLINE void add_to_averages(Pack *p, double weight, const vec *point)
{
    for (int i = 0; i < COORDINATES; i++) {
        vec part = all(weight) * point[i];
        p->step_sum[i] += part;
        p->step_square[i] = madd(part, point[i], p->step_square[i]);
    }
}

#define RATE(s) p[v].rate[s][i]

/* One stage: the sum, the inputs and the rates in one loop body, which is as far as a value stays in a register.
 * KEPT leaves state and inputs in the pack; AGAIN takes the inputs from there, where the time is that of the stage before. */
#define STAGE(s, KEPT, AGAIN)                                                                                         \
    for (Pack *p = packs; p < packs + count; p += ABREAST) {                                                          \
        vec point[ABREAST][STATES], input[ABREAST][INPUT_ROWS], *rate[ABREAST];                                       \
        Row row = row_of(p);                                                                                          \
        EACH rate[v] = p[v].rate[s];                                                                                  \
        UNROLLED for (int i = 0; i < STATES; i++) EACH point[v][i] = madd(p[v].step, SUM_##s, p[v].state[i]);         \
        if (AGAIN) EACH UNROLLED for (int i = 0; i < INPUTS; i++) input[v][i] = p[v].input[i];                        \
        else inputs_at(NODE_##s, row.drives, row.course, vibrates, input);                                            \
        rates(point, input, row.constant, rate);                                                                      \
        if (averages && WEIGHT_##s != 0.0) EACH add_to_averages(p + v, WEIGHT_##s, point[v]);                         \
        if (KEPT) EACH {                                                                                              \
            UNROLLED for (int i = 0; i < STATES; i++) p[v].point[i] = point[v][i];                                    \
            UNROLLED for (int i = 0; i < INPUTS; i++) p[v].input[i] = input[v][i];                                    \
        }                                                                                                             \
    }

/* All stages of the step of each pack; the state at its end is left in `point`. */
NOINLINE void take_stages(Pack *packs, int count, const uint8_t *vibrates, int averages)
{
    for (Pack *p = packs; p < packs + count; p++) {
        begin_course(&p->drives, p->time, all(0.0), p->step, &p->course);
        for (int i = 0; averages && i < COORDINATES; i++) {
            p->step_sum[i] = all(WEIGHT_0) * p->state[i];
            p->step_square[i] = p->step_sum[i] * p->state[i];
        }
    }
    STAGE(1, 0, 0) STAGE(2, 0, 0) STAGE(3, 0, 0) STAGE(4, 0, 0) STAGE(5, 0, 0) STAGE(6, 0, 0)
    STAGE(7, 0, 0) STAGE(8, 0, 0) STAGE(9, 0, 0) STAGE(10, 0, 0) STAGE(11, 1, 0) STAGE(12, 1, 1)
}

/* The rate at the start of the step, where it is not known. */
NOINLINE void begin_steps(Pack *packs, int count, const uint8_t *vibrates)
{
    for (Pack *p = packs; p < packs + count; p += ABREAST) {
        vec state[ABREAST][STATES], input[ABREAST][INPUT_ROWS], found[ABREAST][STATES], *rate[ABREAST];
        Row row = row_of(p);
        EACH {
            begin_course(&p[v].drives, p[v].time, all(0.0), p[v].step, &p[v].course);
            rate[v] = found[v];
            for (int i = 0; i < STATES; i++) state[v][i] = p[v].state[i];
        }
        inputs_at(0.0, row.drives, row.course, vibrates, input);
        rates(state, input, row.constant, rate);
        EACH for (int i = 0; i < STATES; i++)
            p[v].rate[0][i] = pick(below(all(0.5), p[v].fresh), found[v][i], p[v].rate[0][i]);
    }
}

#endif
