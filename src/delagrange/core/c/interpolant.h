/* The interpolant of a step, of order 7: Hairer et al. (1993), Sec. II.6, in its nested form
 * y(x) = y_0 + x (F_0 + (1-x) (F_1 + x (F_2 + (1-x) (F_3 + x (F_4 + (1-x) (F_5 + x F_6)))))), 0 <= x <= 1. */
#ifndef DELAGRANGE_INTERPOLANT_H
#define DELAGRANGE_INTERPOLANT_H

#include "margin.h"
#include "stages.h"

/* Its terms, after `take_stages`; three more stages are needed. */
NOINLINE void interpolate(Pack *packs, int count, const uint8_t *vibrates)
{
    const int averages = 0;
    for (Pack *p = packs; p < packs + count; p++) {
        for (int i = 0; i < COORDINATES; i++) p->end_slope[i] = p->point[COORDINATES + i];
        for (int i = 0; i < STATES; i++) {
            vec rise = p->point[i] - p->state[i], start = p->step * p->rate[0][i];
            p->dense[0][i] = rise;
            p->dense[1][i] = start - rise;
            p->dense[2][i] = madd(-p->step, p->rate[STAGES][i], rise + rise - start);
        }
    }
    STAGE(13, 0, 0) STAGE(14, 0, 0) STAGE(15, 0, 0)
    for (Pack *p = packs; p < packs + count; p++)
        for (int i = 0; i < STATES; i++) {
            enum { v = 0 };
            p->dense[3][i] = p->step * (DENSE_3);
            p->dense[4][i] = p->step * (DENSE_4);
            p->dense[5][i] = p->step * (DENSE_5);
            p->dense[6][i] = p->step * (DENSE_6);
        }
}

/* State variable i of lane k at x of the step. */
static double value_at(Pack *p, int k, int i, double x)
{
    double y = 1.0 - x, total = ROW(dense[5][i]) + x * ROW(dense[6][i]);
    total = ROW(dense[3][i]) + x * (ROW(dense[4][i]) + y * total);
    total = ROW(dense[1][i]) + x * (ROW(dense[2][i]) + y * total);
    return ROW(state[i]) + x * (ROW(dense[0][i]) + y * total);
}

/* One of Newton's steps from x to where state variable i turns, kept within the step. */
INLINE vec to_the_turn(Pack *p, int i, vec x)
{
    vec y = 1.0 - x, value = p->dense[6][i], slope = all(0.0), bend = all(0.0);
    for (int term = 5; term >= -1; term--) {
        vec factor = term % 2 ? x : y;
        double sign = term % 2 ? 1.0 : -1.0; /* of the slope of that factor */
        bend = madd(factor, bend, (2.0 * sign) * slope);
        slope = madd(factor, slope, sign * value);
        if (term >= 0) value = madd(factor, value, p->dense[term][i]);
    }
    return smaller(larger(x - slope / bend, all(0.0)), all(1.0));
}

/* The part of the step at which lane k is lost, by bisection; `point` is its state there. */
#define HALVINGS 60

static double crossing(Pack *p, int k, const Limits *limits)
{
    double low = 0.0, high = 1.0;
    for (int n = 0; n <= HALVINGS; n++) {
        double middle = n < HALVINGS ? 0.5 * (low + high) : high;
        for (int i = 0; i < STATES; i++) ROW(point[i]) = value_at(p, k, i, middle);
        if (n == HALVINGS) break;
        if (holds(kept(p->point, p->input, p->constant, limits), k)) low = middle;
        else high = middle;
    }
    return high;
}

#endif
