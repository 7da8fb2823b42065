/* Where a coordinate turns within a step: which steps may hold the highest or the lowest value of a run, and the value.
 *
 * A step is first looked at through Hermite's polynomial of degree 5, by value, slope and bend at both ends. As a sum of
 * Bernstein's polynomials its slope turns at most as often as the coefficients change sign, and its value lies between
 * the coefficients. Only what may beat the records of its run is looked into with the interpolant, see queue.h.
 */
#ifndef DELAGRANGE_EXTREMA_H
#define DELAGRANGE_EXTREMA_H

#include "interpolant.h"
#include "margin.h"

enum { NOTHING, TURN, TURNS, SAMPLE, LOSS }; /* why a step must be looked into, the weightier the larger */

#define NOISE 1e-15   /* of the value of a coordinate: what rounding makes of it, and no extremum is looked for in */
#define IGNORED 1e-3  /* of the tolerance: several turns within that are not looked for */
#define LOOSE 2e-3    /* relative tolerance above which nothing but its interpolant says what happens in a step */
#define PROBES 32     /* places at which a step that turns more than once is searched */
#define REFINEMENTS 4

/* What is known of a coordinate at both ends of the steps of a pack. */
typedef struct {
    vec first, last, slope_0, slope_1, bend_0, bend_1, rise;
    vec slope[5]; /* Bernstein's coefficients of the slope */
} Ends;

INLINE Ends ends_of(const Pack *p, int i)
{
    Ends e;
    vec h = p->step, hh = h * h;
    e.first = p->state[i], e.last = p->point[i];
    e.slope_0 = h * p->state[COORDINATES + i], e.slope_1 = h * p->point[COORDINATES + i];
    e.bend_0 = hh * p->rate[0][COORDINATES + i], e.bend_1 = hh * p->rate[STAGES][COORDINATES + i];
    e.rise = e.last - e.first;
    e.slope[0] = e.slope_0, e.slope[4] = e.slope_1;
    e.slope[1] = maddc(0.25, e.bend_0, e.slope_0);
    e.slope[3] = maddc(-0.25, e.bend_1, e.slope_1);
    e.slope[2] = maddc(5.0, e.rise, -((e.slope_0 + e.slope_1) + (e.slope[1] + e.slope[3])));
    return e;
}

INLINE mask change_of_sign(vec a, vec b) { return negative(as_bits(a) ^ as_bits(b)); }

/* Slope at x of the step, a number known when this is compiled. */
#define SLOPE_AT(x, b)                                                                                                \
    maddc((1 - x) * (1 - x) * (1 - x) * (1 - x), (b)[0],                                                              \
          maddc(4 * x * (1 - x) * (1 - x) * (1 - x), (b)[1],                                                          \
                maddc(6 * x * x * (1 - x) * (1 - x), (b)[2],                                                          \
                      maddc(4 * x * x * x * (1 - x), (b)[3], all(x * x * x * x) * (b)[4]))))

/* Whether the slope changes its sign at all, and whether it does so more than once, at the quarters of the step. */
INLINE void count_turns(const vec *b, mask *some, mask *many)
{
    vec early = SLOPE_AT(0.25, b), middle = SLOPE_AT(0.5, b), late = SLOPE_AT(0.75, b);
    mask t1 = change_of_sign(b[0], early), t2 = change_of_sign(early, middle);
    mask t3 = change_of_sign(middle, late), t4 = change_of_sign(late, b[4]);
    *some = t1 | t2 | t3 | t4;
    *many = (t1 & (t2 | t3 | t4)) | (t2 & (t3 | t4)) | (t3 & t4);
}

/* Value where the polynomial turns, by one of Newton's steps from where the secant of the slope vanishes. */
INLINE vec value_at_the_turn(const Ends *e)
{
    vec c2 = 0.5 * e->bend_0;
    vec c3 = maddc(10.0, e->rise, maddc(-6.0, e->slope_0, maddc(-4.0, e->slope_1, maddc(-1.5, e->bend_0, 0.5 * e->bend_1))));
    vec c4 = maddc(-15.0, e->rise, maddc(8.0, e->slope_0, maddc(7.0, e->slope_1, maddc(1.5, e->bend_0, -e->bend_1))));
    vec c5 = maddc(6.0, e->rise, maddc(-3.0, e->slope_0 + e->slope_1, -0.5 * (e->bend_0 - e->bend_1)));
    vec d2 = c2 + c2, d3 = 3.0 * c3, d4 = 4.0 * c4, d5 = 5.0 * c5;
    vec x = smaller(larger(e->slope_0 / (e->slope_0 - e->slope_1), all(0.0)), all(1.0));
    vec slope = madd(x, madd(x, madd(x, madd(x, d5, d4), d3), d2), e->slope_0);
    vec bend = madd(x, madd(x, madd(x, 20.0 * c5, 12.0 * c4), 6.0 * c3), d2);
    x = smaller(larger(x - slope / bend, all(0.0)), all(1.0));
    return madd(x, madd(x, madd(x, madd(x, madd(x, c5, c4), c3), c2), e->slope_0), e->first);
}

/* Marks what coordinate i does in the steps of a pack: `flag` TURN where it turns once and may beat a record, its
 * value there left in `top` and how far that may be off in `nearby`; TURNS where it turns more than once. */
INLINE void mark_turns(Pack *p, int i, double doubt, double rtol, double atol)
{
    Ends e = ends_of(p, i);
    const vec *b = e.slope;
    mask ends = change_of_sign(b[0], b[4]);
    mask differ = ends | change_of_sign(b[0], b[1]) | change_of_sign(b[0], b[2]) | change_of_sign(b[0], b[3]);
    if (!any(differ)) return;
    mask some, many;
    count_turns(b, &some, &many);

    /* Bernstein's coefficients of the value bound it, but for what the interpolant may differ by: a share of the bends,
     * and of what a polynomial of degree 3 would be off in the middle. */
    vec cubic = maddc(0.1 / 32.0, e.slope_0 - e.slope_1, (0.1 / 64.0) * (e.bend_0 + e.bend_1));
    vec slack = madd(all(doubt), magnitude(e.bend_0) + magnitude(e.bend_1), magnitude(cubic));
    vec p1 = maddc(0.2, e.slope_0, e.first), p4 = maddc(-0.2, e.slope_1, e.last);
    vec p2 = maddc(0.05, e.bend_0, maddc(0.4, e.slope_0, e.first));
    vec p3 = maddc(0.05, e.bend_1, maddc(-0.4, e.slope_1, e.last));
    vec above = larger(larger(p1, p2), larger(p3, p4)) + slack;
    vec beneath = smaller(smaller(p1, p2), smaller(p3, p4)) - slack;
    vec size = larger(magnitude(e.first), magnitude(e.last)), noise = NOISE * size;
    vec high = larger(p->highest[i], p->record[2 * i] - p->record_nearby[2 * i]) + noise;
    vec low = smaller(p->lowest[i], p->record[2 * i + 1] + p->record_nearby[2 * i + 1]) - noise;
    many &= below(IGNORED * maddc(rtol, size, all(atol)), above - beneath); /* else the noise of a membrane at rest */
    mask down = below(e.slope_0, all(0.0));
    mask hopeful = some & below(pick(down, beneath, high), pick(down, low, above));
    if (!any(hopeful | many)) return;

    vec top = value_at_the_turn(&e);
    mask record = some & below(pick(down, top - slack, high), pick(down, low, top + slack));
    vec mark = pick(many, all(TURNS), pick(record, all(TURN), all(NOTHING)));
    p->top[i] = top;
    p->nearby[i] = slack;
    p->flag = larger(p->flag, mark * p->measured);
}

/* Marks the accepted steps of a pack that must be looked into, and says which; the end of each step is left in `end`. */
INLINE mask mark(Pack *p, double doubt, double rtol, const double *atol, const Limits *limits)
{
    p->end = pick(upto(p->stop - p->time, p->step), p->stop, p->time + p->step);
    vec sampled = pick(below(p->end, p->sample_time), all(NOTHING), all(SAMPLE));
    p->flag = pick(kept(p->point, p->input, p->constant, limits), sampled, all(LOSS));
    if (COORDINATES > 0 && rtol > LOOSE) p->flag = larger(p->flag, TURNS * p->measured);
    else
        for (int i = 0; i < COORDINATES; i++) mark_turns(p, i, doubt, rtol, atol[i]);
    mask looked = upto(p->error, all(1.0)) & below(all(0.5), p->flag);
    p->flag = pick(looked, p->flag, all(NOTHING));
    return looked;
}

/* Where in the step the interpolant of each coordinate turns, into `place`, and its value there, into `top`. */
NOINLINE void refine_turns(Pack *packs, int count)
{
    for (Pack *p = packs; p < packs + count; p++)
        for (int i = 0; i < COORDINATES; i++) {
            vec slope_0 = p->state[COORDINATES + i], slope_1 = p->end_slope[i];
            vec x = smaller(larger(slope_0 / (slope_0 - slope_1), all(0.0)), all(1.0));
            for (int n = 0; n < REFINEMENTS; n++) x = to_the_turn(p, i, x);
            p->place[i] = x;
            for (int k = 0; k < WIDTH; k++) ROW(top[i]) = value_at(p, k, i, LANE(x, k));
        }
}

/* Whether the strain energies hold at x of the step of lane k: an interpolant may swing beyond where no motion goes. */
static int holds_at(Pack *p, int k, double x)
{
    if (!HAS_VALIDITY) return 1;
    vec state[STATES];
    for (int i = 0; i < STATES; i++) state[i] = all(value_at(p, k, i, x));
    vec room = room_of(state, p->input, p->constant);
    return LANE(room, k) > 0.0;
}

/* The place near another where coordinate i turns, not beyond `end` of the step. */
static double refined(Pack *p, int k, int i, double place, double end)
{
    for (int n = 0; n < REFINEMENTS; n++) {
        vec next = to_the_turn(p, i, all(place));
        double x = LANE(next, k);
        if (fabs(x - place) > end / PROBES) break;
        place = x;
    }
    return place < end ? place : end;
}

/* Largest value of sign times the interpolant up to `end` of the step: the best of many probes, each that is higher than
 * its neighbours refined. */
static double largest_of(Pack *p, int k, int i, double sign, double end)
{
    double before = -INFINITY, here = sign * ROW(state[i]), best = here;
    for (int probe = 0; probe <= PROBES; probe++) {
        double next = probe < PROBES ? sign * value_at(p, k, i, end * (probe + 1) / PROBES) : -INFINITY;
        if (here >= before && here >= next) {
            int at_end = probe == 0 || probe == PROBES; /* which may be a turn itself, and counts in any case */
            double near = !at_end ? probe : probe == 0 ? 0.5 : PROBES - 0.5;
            double turn = refined(p, k, i, end * near / PROBES, end), top = sign * value_at(p, k, i, turn);
            if (here > best && (at_end || holds_at(p, k, end * probe / PROBES))) best = here;
            if (top > best && holds_at(p, k, turn)) best = top;
        }
        before = here, here = next;
    }
    return best;
}

#endif
