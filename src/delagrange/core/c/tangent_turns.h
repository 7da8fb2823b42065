/* What happens inside of a step of a tangent: extrema and losses, by shorter steps of the state alone, which have the
 * full accuracy of the pair. */
#ifndef DELAGRANGE_TANGENT_TURNS_H
#define DELAGRANGE_TANGENT_TURNS_H

#include "tangent_state.h"

#define UNCERTAIN 0.05 /* of a step's rise: how far the estimate of an extremum may be off */
#define NEAR 1e-4      /* of a step: how near an extremum must be, to take its value from a parabola */
#define ATTEMPTS 100
#define BISECTIONS 60

#define RATE(s) rate[s][i]
#define ALONE(s)                                                                                                      \
    for (int i = 0; i < STATES; i++) point[0][i] = madd(step, SUM_##s, start[i]);                                     \
    inputs_at(NODE_##s, drives, courses, t->vibrates, input);                                                         \
    into[0] = rate[s];                                                                                                \
    rates(point, input, constant, into);

/* The state alone `shift` seconds after the start of the step, into `part`; its rate there into `slope`; the inputs
 * there into `t->input`. */
NOINLINE void go(Tangent *t, double shift, vec *part, vec *slope)
{
    vec rate[STAGES + 1][STATES], start[STATES], point[ABREAST][STATES], input[ABREAST][INPUT_ROWS], *into[ABREAST];
    const vec *constant[ABREAST] = {t->constant};
    Course course;
    const Drives *drives[ABREAST] = {&t->drives};
    const Course *courses[ABREAST] = {&course};
    const vec step = all(shift);
    begin_course(&t->drives, all(t->time), all(t->since), step, &course);
    for (int i = 0; i < STATES; i++) start[i] = all(OWN(t->state, i)), rate[0][i] = all(OWN(t->rate[0], i));
    ALONE(1) ALONE(2) ALONE(3) ALONE(4) ALONE(5) ALONE(6) ALONE(7) ALONE(8) ALONE(9) ALONE(10) ALONE(11) ALONE(12)
    for (int i = 0; i < STATES; i++) part[i] = point[0][i], slope[i] = rate[STAGES][i];
    for (int i = 0; i < INPUTS; i++) t->input[i] = input[0][i];
}
#undef RATE

/* Value of coordinate i where it turns in the step, from a first guess [s after its start]. */
static double turned(Tangent *t, int i, double guess, double rise)
{
    vec part[STATES], slope[STATES];
    double low = 0.0, high = t->step, shift = guess;
    for (int n = 0; n < ATTEMPTS; n++) {
        go(t, shift, part, slope);
        double rate = first(part[COORDINATES + i]), move = -rate / first(slope[COORDINATES + i]);
        if (fabs(move) <= NEAR * t->step) return first(part[i]) + 0.5 * rate * move;
        if (rate * rise > 0.0) low = shift;
        else high = shift;
        double next = shift + move;
        shift = low < next && next < high ? next : 0.5 * (low + high);
    }
    return first(part[i]);
}

static void raise(double *maximum, double *minimum, double value)
{
    if (value > *maximum) *maximum = value;
    if (value < *minimum) *minimum = value;
}

/* Take the end of the step and the places where a coordinate turns in it into the extrema. It is taken to turn once or
 * not at all: a step in which it turns twice is not accepted at the tolerances that tangents are for. */
static void note_turns(Tangent *t, double *maximum, double *minimum)
{
    const double step = t->step;
    for (int i = 0; i < COORDINATES; i++) {
        double begin = OWN(t->state, i), end = OWN(t->point, i);
        double rise = step * OWN(t->state, COORDINATES + i), fall = step * OWN(t->point, COORDINATES + i);
        raise(maximum + i, minimum + i, end);
        if (!(rise * fall < 0.0)) continue;
        /* Hermite's cubic, whose slope at x of the step is rise + x (2 c2 + 3 x c3) */
        double change = end - begin, c2 = 3.0 * change - 2.0 * rise - fall, c3 = rise + fall - 2.0 * change;
        double x = rise / (rise - fall), top = begin + x * (rise + x * (c2 + x * c3));
        double doubt = UNCERTAIN * (fabs(rise) > fabs(fall) ? fabs(rise) : fabs(fall));
        if (rise > 0.0 ? !(top + doubt > maximum[i]) : !(top - doubt < minimum[i])) continue;
        double bend = step * OWN(t->rate[STAGES], COORDINATES + i), slope = rise + x * (2.0 * c2 + 3.0 * x * c3);
        double better = x - slope / bend;
        if (better > 0.0 && better < 1.0) x = better;
        raise(maximum + i, minimum + i, turned(t, i, x * step, rise));
    }
}

/* The longest shorter step that does not lose the state [s]. */
static double last_kept(Tangent *t)
{
    vec part[STATES], slope[STATES];
    double low = 0.0, high = t->step;
    for (int n = 0; n < BISECTIONS; n++) {
        double middle = 0.5 * (low + high);
        go(t, middle, part, slope);
        if (holds(kept(part, t->input, t->constant, &t->limits), 0)) low = middle;
        else high = middle;
    }
    return low;
}

#endif
