/* Error and step: one controller, for runs side by side and for tangents alike.
 *
 * Gustafsson (1991), ACM Trans. Math. Softw. 17, 533: the next step follows from this error and the last one. Errors
 * are squared and in units of the tolerance, so that a step is accepted up to 1; what the controller remembers is the
 * binary logarithm.
 */
#ifndef DELAGRANGE_CONTROL_H
#define DELAGRANGE_CONTROL_H

#include "vectors.h"

#define SAFETY 0.9
#define GROWTH 0.025          /* exponents of squared errors: of this step, of the one before, */
#define MEMORY 0.01
#define SHRINKING 0.0625      /* and of one that is rejected */
#define SMALLEST_FACTOR 0.2   /* of a step to the next */
#define LARGEST_FACTOR 6.0
#define FIRST_SIZE (-26.0)    /* of the error that a first step is taken to follow */
#define FIRST_STEP 0.05       /* over the time in which a drive turns */
#define SHORTEST 1e-16        /* step over the whole time at which a run is given up */
#define RESOLUTION 2.5e-15    /* step over time at which it is */

/* Squared error in units of the tolerance from the sums of squares of both estimates: Hairer et al. (1993), Sec. II.10. */
INLINE vec squared_error(vec step, vec fifth, vec third, double count)
{
    vec weight = maddc(0.01, third, fifth) + 1e-300, reach = step * fifth;
    return reach * reach / (weight * count);
}

/* Binary logarithm and power, straight between powers of two: the exponent's bits are those of a whole number. */
INLINE vec logarithm(vec x)
{
    vec high = as_vec((as_bits(x) >> 32) | 0x4330000000000000ULL) - 4503599627370496.0;
    return maddc(9.5367431640625e-07, high, all(-1022.957));
}

INLINE vec power_of_two(vec x) { return as_vec(as_bits(x + (1022.957 + 6442450944.0)) << 32); }

/* Size of a squared error, as the controller remembers it; of one that is no number, the largest. */
INLINE vec size_of(vec error) { return logarithm(larger(smaller(error, all(1e20)), all(1e-20))); }

/* By what the step changes after one that is accepted, and after one that is not. */
INLINE vec growth_after(vec size, vec old_size)
{
    vec factor = SAFETY * power_of_two(maddc(MEMORY, old_size, -GROWTH * size));
    return smaller(larger(factor, all(SMALLEST_FACTOR)), all(LARGEST_FACTOR));
}

INLINE vec shrinking_after(vec size)
{
    vec factor = SAFETY * power_of_two(-SHRINKING * size);
    return smaller(larger(factor, all(SMALLEST_FACTOR)), all(SAFETY));
}

/* The step up to which a run is given up [s]. */
INLINE vec hopeless(vec time, double whole_time) { return larger(RESOLUTION * magnitude(time), all(SHORTEST * whole_time)); }

/* The step of at most `wish` to take from a time on: it ends at a time that is a double, so that the steps of a run add up
 * to its times however late it is. */
INLINE vec step_from(vec time, vec wish, vec stop)
{
    vec left = stop - time;
    return pick(below(wish, left), (time + wish) - time, left);
}

#endif
