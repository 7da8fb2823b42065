/* A state and its tangent side by side: lane 0 of the first group is the state, the lanes after it are the columns. */
#ifndef DELAGRANGE_TANGENT_STATE_H
#define DELAGRANGE_TANGENT_STATE_H

#include "control.h"
#include "drives.h"
#include "library.h"
#include "margin.h"
#include "pair.h"

typedef vec (*Matrix)[STATES]; /* (groups, STATES) */

typedef struct {
    int groups;
    int64_t columns;
    Matrix state, point, rate[STAGES + 1]; /* at the start of the step, at a stage and at last at its end; rates */
    vec (*push)[INPUT_ROWS];               /* derivative of each input by what a column follows */
    vec trace[STAGES + 1];
    double divergence, next_divergence;    /* since the last of the times; at the end of the step */
    double *length;                        /* (columns,), of each column at the last of the times */
    vec constant[CONSTANT_ROWS], input[INPUT_ROWS], weight[STATES], others; /* `others`: 0 in lane 0, else 1 */
    Drives drives;
    Course course;
    Limits limits;
    double time, since, step;              /* [s]: the last of the times, since then, the step */
    double wish, old_size, room_at_rest;
    int64_t row;
    int fresh;                             /* the rates at the start of the step are not known */
    uint8_t vibrates[INPUT_ROWS], followed[INPUT_ROWS];
} Tangent;

#define ENTRY(matrix, column, i) LANE((matrix)[((column) + 1) / WIDTH][i], ((column) + 1) % WIDTH)
#define OWN(matrix, i) first((matrix)[0][i]) /* of the state itself */

INLINE mask own_lane(const Tangent *t) { return below(t->others, all(0.5)); }

/* Derivatives of an input by the numbers of its drive, at a node of the step. */
static void drive_slopes(const Tangent *t, int i, double node, double *slope)
{
    const double turn = 6.283185307179586, time = (t->time + t->since) + node * t->step;
    vec sin_of[1] = {maddc(node, t->course.turns_step[i], t->course.turns[i])}, cos_of[1] = {sin_of[0] + QUARTER_TURN};
    sine(sin_of);
    sine(cos_of);
    double swing = first(t->drives.amplitude[i]) * first(cos_of[0]);
    slope[DELAGRANGE_LEVEL] = 1.0;
    slope[DELAGRANGE_SLOPE] = time - first(t->drives.start);
    slope[DELAGRANGE_AMPLITUDE] = first(sin_of[0]);
    slope[DELAGRANGE_FREQUENCY] = turn * time * swing;
    slope[DELAGRANGE_PHASE] = swing;
}

/* Inputs at a node of the step, and what they push the columns by. */
static void place_inputs(Tangent *t, const int64_t *sources, double node)
{
    const Drives *drives[ABREAST] = {&t->drives};
    const Course *course[ABREAST] = {&t->course};
    inputs_at(node, drives, course, t->vibrates, &t->input);
    for (int i = 0; i < INPUTS; i++) {
        double slope[DELAGRANGE_DRIVE_ROWS];
        if (!t->followed[i]) continue;
        drive_slopes(t, i, node, slope);
        for (int64_t column = 0; column < t->columns; column++)
            if (sources[2 * column] == i) ENTRY(t->push, column, i) = slope[sources[2 * column + 1]];
    }
}

/* Rates of state and columns at a node of the step. */
NOINLINE void evaluate(Tangent *t, const int64_t *sources, double node, Matrix point, int stage)
{
    vec state[STATES], rate[STATES];
    for (int i = 0; i < STATES; i++) state[i] = all(OWN(point, i));
    place_inputs(t, sources, node);
    motion(t->groups, state, t->input, t->constant, point, t->push, rate, t->rate[stage], &t->trace[stage]);
    mask own = own_lane(t);
    for (int i = 0; i < STATES; i++) t->rate[stage][0][i] = pick(own, rate[i], t->rate[stage][0][i]);
}

INLINE void begin_tangent_step(Tangent *t, double step)
{
    t->step = step;
    begin_course(&t->drives, all(t->time), all(t->since), all(step), &t->course);
}

#define RATE(s) t->rate[s][g][i]
#define SUM_OF(s)                                                                                                     \
    for (int g = 0; g < t->groups; g++)                                                                               \
        for (int i = 0; i < STATES; i++) t->point[g][i] = madd(step, SUM_##s, t->state[g][i]);
#define TANGENT_STAGE(s) SUM_OF(s) evaluate(t, sources, NODE_##s, t->point, s);

/* State and columns a step ahead, into `point`; their rates at its start are there already. */
static void advance(Tangent *t, const int64_t *sources)
{
    const vec step = all(t->step);
    TANGENT_STAGE(1) TANGENT_STAGE(2) TANGENT_STAGE(3) TANGENT_STAGE(4) TANGENT_STAGE(5) TANGENT_STAGE(6)
    TANGENT_STAGE(7) TANGENT_STAGE(8) TANGENT_STAGE(9) TANGENT_STAGE(10) TANGENT_STAGE(11)
    SUM_OF(12)
#undef RATE
#define RATE(s) t->trace[s]
    t->next_divergence = t->divergence + first(step * (SUM_12));
}
#undef RATE

/* Length of each column in units of the weights, a group. */
INLINE vec lengths(const Tangent *t, Matrix matrix, int g)
{
    vec total = all(0.0);
    for (int i = 0; i < STATES; i++) {
        vec part = matrix[g][i] / t->weight[i];
        total = madd(part, part, total);
    }
    return vec_sqrt(total);
}

/* Sum over state and columns, in their order whatever the width. */
static double total_of(const Tangent *t, const vec *groups)
{
    double total = 0.0;
    for (int64_t lane = 0; lane <= t->columns; lane++) total += ((const double *)groups)[lane];
    return total;
}

/* Squared error of the step in units of the tolerance. That of the state is relative to its weights, or to its size
 * where that is larger; that of a column to its length, now or at the last of the times; that of the divergence is
 * absolute. `scratch` has room for three vectors a group. */
static double tangent_error(const Tangent *t, double tolerance, vec *scratch)
{
    vec *fifths = scratch, *thirds = scratch + t->groups, *length = scratch + 2 * t->groups;
    mask own = own_lane(t);
    for (int g = 0; g < t->groups; g++) length[g] = larger(lengths(t, t->state, g), lengths(t, t->point, g));
    for (int64_t column = 0; column < t->columns; column++) {
        double *now = (double *)length + column + 1;
        *now = (*now > t->length[column] ? *now : t->length[column]) + 1e-300;
    }
    for (int g = 0; g < t->groups; g++) {
        fifths[g] = thirds[g] = all(0.0);
        for (int i = 0; i < STATES; i++) {
            vec size = larger(t->weight[i], larger(magnitude(t->state[g][i]), magnitude(t->point[g][i])));
            vec scale = t->weight[i] * length[g];
            if (g == 0) scale = pick(own, size, scale);
#define RATE(s) t->rate[s][g][i]
            vec fifth = (ERROR_5) / scale, third = (ERROR_3) / scale;
#undef RATE
            fifths[g] = madd(fifth, fifth, fifths[g]);
            thirds[g] = madd(third, third, thirds[g]);
        }
    }
#define RATE(s) t->trace[s]
    double fifth = first(ERROR_5), third = first(ERROR_3);
#undef RATE
    double fives = total_of(t, fifths) + fifth * fifth, threes = total_of(t, thirds) + third * third;
    vec error = squared_error(all(t->step), all(fives), all(threes), (double)(STATES * (t->columns + 1) + 1));
    return first(error) / (tolerance * tolerance);
}

#endif
