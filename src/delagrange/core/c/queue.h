/* Steps that must be looked into: copied to a queue, and gone through once more side by side when there are enough. */
#ifndef DELAGRANGE_QUEUE_H
#define DELAGRANGE_QUEUE_H

#include "extrema.h"

typedef struct {
    Pack *packs;
    int count; /* steps in it, WIDTH a pack */
} Queue;

/* Only what the step begins with: to go through it again takes less time than to copy its rates. */
INLINE void copy_lane(const Pack *from, int k, Pack *to, int place)
{
    const double *source = (const double *)from + k;
    double *target = (double *)to + place;
    for (int row = 0; row < COPIED; row++) target[row * WIDTH] = source[row * WIDTH];
}

INLINE void enqueue(Queue *queue, const Pack *p, int k)
{
    copy_lane(p, k, queue->packs + queue->count / WIDTH, queue->count % WIDTH);
    queue->count++;
}

/* Take the first `done` steps out of the queue. */
static void move_up(Queue *queue, int done)
{
    for (int place = done; place < queue->count; place++) {
        int to = place - done;
        copy_lane(queue->packs + place / WIDTH, place % WIDTH, queue->packs + to / WIDTH, to % WIDTH);
    }
    queue->count = queue->count < done ? 0 : queue->count - done;
}

/* Of a step that turns once, keep what is needed to look into it if it beats the record of its run; queue it where
 * that is not sure. So most records are forgotten again, and one step a run is left to look into. */
static void settle(Queue *queue, Pack *p, int k)
{
    for (int i = 0; i < COORDINATES; i++) {
        double slope = ROW(state[COORDINATES + i]);
        if (slope * ROW(point[COORDINATES + i]) >= 0.0) continue;
        int r = 2 * i + (slope > 0.0 ? 0 : 1);
        double ahead = (slope > 0.0 ? 1.0 : -1.0) * (ROW(top[i]) - ROW(record[r]));
        double doubt = ROW(nearby[i]) + ROW(record_nearby[r]);
        if (ahead > doubt) {
            ROW(record[r]) = ROW(top[i]), ROW(record_nearby[r]) = ROW(nearby[i]);
            ROW(record_time[r]) = ROW(time), ROW(record_step[r]) = ROW(step);
            for (int j = 0; j < STATES; j++) ROW(record_state[r][j]) = ROW(state[j]);
        } else if (ahead > -doubt)
            enqueue(queue, p, k);
    }
}

/* Queue the steps that hold the records of a lane, and forget them. */
static void queue_records(Queue *queue, Pack *p, int k)
{
    for (int r = 0; r < 2 * COORDINATES; r++) {
        if (!(ROW(record_step[r]) > 0.0)) continue;
        Pack *to = queue->packs + queue->count / WIDTH;
        int place = queue->count % WIDTH;
        enqueue(queue, p, k);
        LANE(to->time, place) = ROW(record_time[r]);
        LANE(to->step, place) = ROW(record_step[r]);
        for (int j = 0; j < STATES; j++) LANE(to->state[j], place) = ROW(record_state[r][j]);
        LANE(to->kind, place) = TURN, LANE(to->measured, place) = 1.0;
        ROW(record_step[r]) = 0.0;
    }
}

#endif
