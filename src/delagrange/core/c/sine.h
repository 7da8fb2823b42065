/* The sine, of what is counted in half turns. */
#ifndef DELAGRANGE_SINE_H
#define DELAGRANGE_SINE_H

#include "abreast.h"
#include "vectors.h"

#define QUARTER_TURN 0.5 /* in half turns: what a cosine is ahead of a sine */

/* sin(pi x) in place of x, right to 4e-16 of one: the nearest whole number of half turns is taken off, and there the
 * sine is a polynomial, nearly the best of its degree (Chebyshev's, fitted with many digits). The whole number is in
 * the last bit of what WHOLES is added to: it says whether the sign changes. */
INLINE void sine(vec *x)
{
    VALUE(sum) = x[v] + WHOLES;
    VALUE(part) = x[v] - (sum[v] - WHOLES);
    VALUE(square) = part[v] * part[v];
    VALUE(value) = maddc(-2.113362735205297e-05, square[v], all(0.0004659870158043378));
    EACH value[v] = madd(square[v], value[v], all(-0.0073703643265304155));
    EACH value[v] = madd(square[v], value[v], all(0.08214587881631043));
    EACH value[v] = madd(square[v], value[v], all(-0.599264528825224));
    EACH value[v] = madd(square[v], value[v], all(2.5501640398618677));
    EACH value[v] = madd(square[v], value[v], all(-5.1677127800497855));
    EACH value[v] = madd(square[v], value[v], all(3.1415926535897927));
    EACH x[v] = as_vec(as_bits(part[v] * value[v]) ^ (as_bits(sum[v]) << 63));
}

#endif
