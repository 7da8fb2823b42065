/* When a run counts as lost, and how that is called. */
#ifndef DELAGRANGE_MARGIN_H
#define DELAGRANGE_MARGIN_H

#include "delagrange.h"
#include "model.h"

#define AT_THE_LOCK 1e-6 /* of the room at rest: what is left where a spring counts as locked once no step is resolved */

typedef struct {
    double smallest, largest; /* principal stretch, in-plane stretch [1] */
} Limits;

/* What is left to the limits of the strain energies [1]; more than anything where they have none. */
INLINE vec room_of(const vec *state, const vec *input, const vec *constant)
{
#if HAS_VALIDITY
    vec room;
    validity(state, input, constant, &room);
    return room;
#else
    (void)state, (void)input, (void)constant;
    return all(INFINITY);
#endif
}

/* Where the stretches lie within the limits, and the strain energies hold. */
INLINE mask kept(const vec *state, const vec *input, const vec *constant, const Limits *limits)
{
    vec least, most;
    stretches(state, input, constant, &least, &most);
    mask within = below(all(limits->smallest), least) & below(most, all(limits->largest));
#if HAS_VALIDITY
    within &= below(all(0.0), room_of(state, input, constant));
#endif
    return within;
}

/* What has happened to lane k, whose state is not kept: the limit that it is farthest beyond decides. */
INLINE int kind_of_loss(const vec *state, const vec *input, const vec *constant, const Limits *limits, int k)
{
    vec least, most, room = room_of(state, input, constant);
    stretches(state, input, constant, &least, &most);
    double above = LANE(least, k) / limits->smallest - 1.0, beneath = 1.0 - LANE(most, k) / limits->largest;
    if (HAS_VALIDITY && !(LANE(room, k) > above || LANE(room, k) > beneath)) return DELAGRANGE_LOCKED; /* no number either */
    return beneath < above ? DELAGRANGE_DIVERGED : DELAGRANGE_COLLAPSED;
}

/* What has happened to a run that no step resolves: a spring that locks stops it within less than can be told. */
INLINE int kind_of_failure(double room, double room_at_rest)
{
    return HAS_VALIDITY && room < AT_THE_LOCK * room_at_rest ? DELAGRANGE_LOCKED : DELAGRANGE_UNRESOLVED;
}

/* The room in the reference state of a membrane of these parameters [1]. */
INLINE double room_at_rest(const double *parameter, const double *constant)
{
#if HAS_VALIDITY
    double reference_state[STATES];
    vec state[STATES], input[INPUT_ROWS], still[CONSTANT_ROWS];
    reference(parameter, reference_state);
    for (int i = 0; i < STATES; i++) state[i] = all(reference_state[i]);
    for (int i = 0; i < INPUT_ROWS; i++) input[i] = all(0.0);
    for (int i = 0; i < ALL_CONSTANTS; i++) still[i] = all(constant[i]);
    return first(room_of(state, input, still));
#else
    (void)parameter, (void)constant;
    return INFINITY;
#endif
}

#endif
