/* What is known of WIDTH runs that advance side by side. Every row is a vector with a number a run. */
#ifndef DELAGRANGE_PACK_H
#define DELAGRANGE_PACK_H

#include "drives.h"
#include "pair.h"

#define RECORDS (2 * COORDINATE_ROWS) /* highest and lowest of each coordinate */

typedef struct {
    /* What a step that is looked into once more is copied with, up to `state`. */
    vec constant[CONSTANT_ROWS];
    Drives drives;
    vec time, end;                  /* [s], at the start and at the end of the step */
    vec step;                       /* [s], to try next */
    vec measured, measured_time;    /* 1 in the window of extrema and averages, else 0; [s], of the pieces before */
    vec sample, sample_time;        /* number of the next sample; [s], of it */
    vec run, kind;                  /* which run; what a copied step is looked into for, as `flag` */
    vec steps, rejections;
    vec highest[COORDINATE_ROWS], lowest[COORDINATE_ROWS]; /* at the ends of steps */
    vec sum[COORDINATE_ROWS], square[COORDINATE_ROWS];     /* integrals over time, of the coordinate and its square */
    vec state[STATES];              /* at the start of the step */

    /* The rest is made anew from that. */
    vec rate[ALL_STAGES][STATES];
    vec point[STATES], input[INPUT_ROWS]; /* at a stage, at last at the end of the step */
    Course course;
    vec stop, wish, length;         /* [s], end of the piece; the step that the error asks for; the step just tried */
    vec error, old_size;            /* squared, in units of the tolerance; its logarithm at the last accepted step */
    vec accepted, leaves, fresh;    /* 1 or 0; 1 at the end of a piece, 2 where no step is resolved; 1 without a rate */
    vec flag;                       /* why the step must be looked into, see extrema.h */
    vec room_at_rest;               /* what is left to the limits of the energies in the reference state [1] */
    vec step_sum[COORDINATE_ROWS], step_square[COORDINATE_ROWS]; /* means over the step */
    vec top[COORDINATE_ROWS], nearby[COORDINATE_ROWS]; /* value where the coordinate turns; how far that may be off */
    vec record[RECORDS], record_nearby[RECORDS];       /* the highest and the lowest of them so far */
    vec record_time[RECORDS], record_step[RECORDS];    /* [s], of the step that holds it; 0 where there is none */
    vec record_state[RECORDS][STATES];                 /* at its start */
    vec end_slope[COORDINATE_ROWS], dense[7][STATES];  /* at the end of the step; terms of its interpolant */
    vec place[COORDINATE_ROWS];                        /* where in the step it turns */
} Pack;

#define COPIED (CONSTANT_ROWS + 5 * INPUT_ROWS + 1 + 11 + 4 * COORDINATE_ROWS + STATES)

#define ROW(name) LANE(p->name, k) /* of lane k of pack p */

#endif
