/* Error of the steps of a pack, and what is done about it. */
#ifndef DELAGRANGE_ERRORS_H
#define DELAGRANGE_ERRORS_H

#include "control.h"
#include "stages.h"

#define TOGETHER 6 /* state variables whose scales share a division: more could leave the range of doubles */

INLINE void estimate_error(Pack *p, double rtol, const double *atol)
{
    enum { v = 0 };
    vec fifth = all(0.0), third = all(0.0);
    for (int begin = 0; begin < STATES; begin += TOGETHER) {
        vec size[TOGETHER], before[TOGETHER], product = all(1.0);
        const int count = STATES - begin < TOGETHER ? STATES - begin : TOGETHER;
        UNROLLED for (int n = 0; n < count; n++) {
            vec largest = larger(magnitude(p->state[begin + n]), magnitude(p->point[begin + n]));
            size[n] = maddc(rtol, largest, all(atol[begin + n]));
            before[n] = product;
            product = product * size[n];
        }
        vec inverse = 1.0 / product; /* of those that are left */
        UNROLLED for (int n = count - 1; n >= 0; n--) {
            const int i = begin + n;
            vec scale = before[n] * inverse;
            inverse = inverse * size[n];
            vec five = scale * (ERROR_5), three = scale * (ERROR_3);
            fifth = madd(five, five, fifth);
            third = madd(three, three, third);
        }
    }
    p->error = squared_error(p->step, fifth, third, STATES);
}

/* Accept or reject, choose the next step, take the state; whether a lane has to be seen to. */
INLINE int control(Pack *p, double whole_time)
{
    vec step = p->step, begin = p->time, stop = p->stop, old_wish = p->wish;
    mask accepted = upto(p->error, all(1.0));
    vec size = size_of(p->error), time = pick(accepted, p->end, begin);
    vec wish = step * pick(accepted, growth_after(size, p->old_size), shrinking_after(size));
    mask cut = accepted & upto(stop, p->end) & below(wish, old_wish); /* the step ended where the piece did */
    wish = pick(cut, old_wish, wish);
    mask resolved = below(hopeless(begin, whole_time), wish);
    p->leaves = pick(resolved, pick(below(time, stop), all(0.0), all(1.0)), all(2.0));
    p->accepted = pick(accepted, all(1.0), all(0.0));
    p->steps += p->accepted;
    p->rejections += 1.0 - p->accepted;
    p->old_size = pick(accepted, size, p->old_size);
    p->time = time;
    p->wish = wish;
    p->length = step;
    p->step = step_from(time, wish, stop);
    for (int i = 0; i < STATES; i++) {
        p->state[i] = pick(accepted, p->point[i], p->state[i]);
        p->rate[0][i] = pick(accepted, p->rate[STAGES][i], p->rate[0][i]);
    }
    mask measured = below(all(0.5), p->measured);
    for (int i = 0; i < COORDINATES; i++) {
        vec value = p->state[i];
        p->highest[i] = pick(measured & below(p->highest[i], value), value, p->highest[i]);
        p->lowest[i] = pick(measured & below(value, p->lowest[i]), value, p->lowest[i]);
    }
    return any(below(all(0.5), p->leaves));
}

/* A first step for lane k [s]: a hundredth of the time in which its state would change by itself (Sec. II.4). */
static double first_step(Pack *p, int k, double rtol, const double *atol, double whole_time)
{
    double size = 0.0, speed = 0.0, fastest = 0.0;
    for (int i = 0; i < STATES; i++) {
        double scale = atol[i] + rtol * fabs(ROW(state[i]));
        double sized = ROW(state[i]) / scale, moving = ROW(rate[0][i]) / scale;
        size += sized * sized, speed += moving * moving;
    }
    for (int i = 0; i < INPUTS; i++)
        if (ROW(drives.amplitude[i]) != 0.0 && ROW(drives.frequency[i]) > fastest) fastest = ROW(drives.frequency[i]);
    double step = speed > 1e-12 * size ? 0.01 * sqrt(size / speed) : 1e-3 * whole_time;
    if (!(step > 1e-12 * whole_time)) step = 1e-12 * whole_time; /* of a state of nothing but zeros as well */
    if (fastest > 0.0 && FIRST_STEP / fastest < step) step = FIRST_STEP / fastest;
    double resolved = 10.0 * RESOLUTION * fabs(ROW(time)); /* of a run that begins late */
    return step > resolved ? step : resolved;
}

#endif
