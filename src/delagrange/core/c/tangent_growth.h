/* The columns of a tangent made orthonormal, and what they had grown by. */
#ifndef DELAGRANGE_TANGENT_GROWTH_H
#define DELAGRANGE_TANGENT_GROWTH_H

#include "tangent_state.h"

static double length_of(const Tangent *t, int64_t column)
{
    double total = 0.0;
    for (int i = 0; i < STATES; i++) {
        double part = ENTRY(t->state, column, i) / first(t->weight[i]);
        total += part * part;
    }
    return sqrt(total);
}

/* Take what lies along another column out of a column. */
static void take_out(Tangent *t, int64_t column, int64_t other)
{
    double product = 0.0;
    for (int i = 0; i < STATES; i++) {
        double weight = first(t->weight[i]);
        product += (ENTRY(t->state, column, i) / weight) * (ENTRY(t->state, other, i) / weight);
    }
    for (int i = 0; i < STATES; i++) ENTRY(t->state, column, i) -= product * ENTRY(t->state, other, i);
}

/* Orthonormal in units of the weights, in their order; the logarithms of their lengths go to `growth`. Modified Gram
 * and Schmidt, twice (Giraud et al. 2005, Numer. Math. 101, 87). */
static void orthonormalise(Tangent *t, double *growth)
{
    for (int64_t column = 0; column < t->columns; column++) {
        growth[column] = 0.0;
        for (int again = 0; again < 2; again++) {
            for (int64_t other = 0; other < column; other++) take_out(t, column, other);
            double length = length_of(t, column);
            growth[column] += log(length);
            for (int i = 0; i < STATES && length > 0.0; i++) ENTRY(t->state, column, i) /= length;
        }
    }
}

#endif
