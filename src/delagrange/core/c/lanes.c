/* Many runs side by side. Each has its own time, step and error: none feels its neighbours, and when one has ended the
 * next takes its seat. */
#include "library.h"

#include "errors.h"
#include "queue.h"

#ifndef PACKS
#define PACKS 4
#endif
#define LANES (PACKS * WIDTH)
#define QUEUE_PACKS (PACKS * (3 + 4 * COORDINATES)) /* more than one step of all lanes may need */
#define DOUBT 5e-6   /* of the bend of a step: how far an estimate of where it turns may be off, at tight tolerances */
#define LOOK 256     /* turns after which progress is reported */

typedef struct {
    const delagrange_runs *job;
    Limits limits;
    double begin, duration, doubt;
    uint8_t vibrates[INPUT_ROWS];
} Task;

INLINE double at(const double *rows, int64_t row, int64_t columns, int64_t column) { return rows[row * columns + column]; }

INLINE int64_t column_of(int64_t run, int64_t columns) { return columns == 1 ? 0 : run; }

/* ---- what is kept of a run ---- */

static void raise_extrema(const delagrange_runs *job, int64_t run, int i, double high, double low)
{
    double *maximum = job->maximum + i * job->runs + run, *minimum = job->minimum + i * job->runs + run;
    if (high > *maximum) *maximum = high;
    if (low < *minimum) *minimum = low;
}

/* Time of a sample [s]; never, where there are no more. Rounding takes none away. */
static double sample_time(const Task *task, int64_t run, double number)
{
    if (!(number < (double)task->job->sample_count)) return INFINITY;
    double time = task->job->first_sample[run] + number * task->job->sample_spacing[run];
    double end = task->begin + task->duration;
    return end < time && time <= end + 1e-14 * task->duration ? end : time;
}

static void keep_sample(const delagrange_runs *job, int64_t run, int64_t number, int i, double value)
{
    job->samples[(number * STATES + i) * job->runs + run] = value;
}

/* Write what a lane has come to: its state at `point`, and all that was measured. */
static void keep(Pack *p, int k, int64_t run, const Task *task, int status, double time)
{
    const delagrange_runs *job = task->job;
    double span = ROW(measured_time);
    for (int i = 0; i < COORDINATES; i++) {
        raise_extrema(job, run, i, ROW(highest[i]), ROW(lowest[i]));
        job->mean[i * job->runs + run] = job->averages ? ROW(sum[i]) / span : NAN;
        job->mean_square[i * job->runs + run] = job->averages ? ROW(square[i]) / span : NAN;
    }
    for (int i = 0; i < STATES; i++) job->last_state[i * job->runs + run] = ROW(point[i]);
    job->status[run] = status;
    job->status_time[run] = time;
    job->steps[run] = (int64_t)ROW(steps);
    job->rejections[run] = (int64_t)ROW(rejections);
}

/* ---- averages ---- */

/* Take the accepted steps into the integrals; what is not accepted may be no number. */
INLINE void take_averages(Pack *p)
{
    vec share = p->length * p->accepted * p->measured;
    mask some = below(all(0.0), share);
    for (int i = 0; i < COORDINATES; i++) {
        p->sum[i] = madd(share, pick(some, p->step_sum[i], all(0.0)), p->sum[i]);
        p->square[i] = madd(share, pick(some, p->step_square[i], all(0.0)), p->square[i]);
    }
}

/* Take the first part of a step into them, by quadrature of its interpolant. */
static void averages_upto(Pack *p, int k, double end)
{
    for (int i = 0; i < COORDINATES; i++)
        for (int n = 0; n < QUADRATURE_POINTS; n++) {
            double value = value_at(p, k, i, QUADRATURE[n][0] * end), share = QUADRATURE[n][1] * end * ROW(step);
            ROW(sum[i]) += share * value;
            ROW(square[i]) += share * value * value;
        }
}

/* ---- looking into queued steps ---- */

static void look_for_extrema(Pack *p, int k, const Task *task, double end)
{
    for (int i = 0; i < COORDINATES; i++) {
        double high, low;
        int once = ROW(kind) < TURN + 0.5 && holds_at(p, k, ROW(place[i]));
        if (!once) high = largest_of(p, k, i, 1.0, end), low = -largest_of(p, k, i, -1.0, end);
        else if (ROW(state[COORDINATES + i]) * ROW(end_slope[i]) < 0.0) high = low = ROW(top[i]);
        else continue;
        raise_extrema(task->job, (int64_t)ROW(run), i, high, low);
    }
}

static void look_for_samples(Pack *p, int k, const Task *task, double end, double part)
{
    int64_t run = (int64_t)ROW(run);
    while (ROW(sample_time) <= end) {
        double x = (ROW(sample_time) - ROW(time)) / ROW(step);
        for (int i = 0; i < STATES; i++)
            keep_sample(task->job, run, (int64_t)ROW(sample), i, value_at(p, k, i, x < part ? x : part));
        ROW(sample) += 1.0;
        ROW(sample_time) = sample_time(task, run, ROW(sample));
    }
}

static void look_into(Pack *p, int k, const Task *task)
{
    int lost = ROW(kind) > LOSS - 0.5; /* as it was found: next to a limit, rounding may give another end here */
    double part = lost ? crossing(p, k, &task->limits) : 1.0;
    double end = lost ? ROW(time) + part * ROW(step) : ROW(end);
    if (ROW(measured) > 0.5) look_for_extrema(p, k, task, part);
    if (ROW(kind) > SAMPLE - 0.5) look_for_samples(p, k, task, end, part);
    if (!lost) return;
    if (ROW(measured) > 0.5) {
        ROW(measured_time) += end - ROW(drives.start);
        if (task->job->averages) averages_upto(p, k, part);
    }
    ROW(steps) += 1.0;
    keep(p, k, (int64_t)ROW(run), task, kind_of_loss(p->point, p->input, p->constant, &task->limits, k), end);
}

static void empty(Queue *queue, const Task *task)
{
    int count = queue->count < LANES ? queue->count : LANES;
    begin_steps(queue->packs, PACKS, task->vibrates); /* whose lanes are all fresh */
    take_stages(queue->packs, PACKS, task->vibrates, 0);
    interpolate(queue->packs, PACKS, task->vibrates);
    refine_turns(queue->packs, PACKS);
    for (int lane = 0; lane < count; lane++) look_into(queue->packs + lane / WIDTH, lane % WIDTH, task);
    move_up(queue, LANES);
}

/* ---- seats ---- */

/* Give a lane the drives of the next piece of time. */
static void open_piece(Pack *p, int k, int64_t run, int64_t piece, const Task *task)
{
    const delagrange_runs *job = task->job;
    const double *span = job->pieces + DELAGRANGE_PIECE_COLUMNS * piece;
    const double *drive = job->drives + piece * DELAGRANGE_DRIVE_ROWS * INPUTS * job->drive_columns;
    if (ROW(measured) > 0.5) ROW(measured_time) += ROW(stop) - ROW(drives.start);
    ROW(drives.start) = span[DELAGRANGE_BEGIN], ROW(stop) = span[DELAGRANGE_END];
    ROW(measured) = span[DELAGRANGE_MEASURED];
    int64_t columns = job->drive_columns, column = column_of(run, columns);
    for (int i = 0; i < INPUTS; i++) {
        ROW(drives.level[i]) = at(drive, DELAGRANGE_LEVEL * INPUTS + i, columns, column);
        ROW(drives.slope[i]) = at(drive, DELAGRANGE_SLOPE * INPUTS + i, columns, column);
        ROW(drives.amplitude[i]) = at(drive, DELAGRANGE_AMPLITUDE * INPUTS + i, columns, column);
        ROW(drives.frequency[i]) = at(drive, DELAGRANGE_FREQUENCY * INPUTS + i, columns, column);
        ROW(drives.phase[i]) = at(drive, DELAGRANGE_PHASE * INPUTS + i, columns, column);
    }
    for (int i = 0; i < COORDINATES && ROW(measured) > 0.5; i++) {
        if (ROW(state[i]) > ROW(highest[i])) ROW(highest[i]) = ROW(state[i]);
        if (ROW(state[i]) < ROW(lowest[i])) ROW(lowest[i]) = ROW(state[i]);
    }
    ROW(fresh) = 1.0;
}

static void seat_membrane(Pack *p, int k, int64_t run, const delagrange_runs *job)
{
    double parameter[PARAMETER_ROWS] = {0.0}, constant[CONSTANT_ROWS] = {0.0};
    int64_t column = column_of(run, job->parameter_columns);
    for (int i = 0; i < PARAMETERS; i++) parameter[i] = at(job->parameters, i, job->parameter_columns, column);
    constants(parameter, constant);
    for (int i = 0; i < CONSTANTS; i++) ROW(constant[i]) = constant[i];
    ROW(room_at_rest) = room_at_rest(parameter, constant);
    for (int i = 0; i < STATES; i++) ROW(state[i]) = ROW(point[i]) = at(job->state, i, job->runs, run);
    for (int i = 0; i < INPUTS; i++) ROW(input[i]) = 0.0;
}

/* Put a run into a lane, where it begins. */
static void seat(Pack *p, int k, int64_t run, const Task *task)
{
    seat_membrane(p, k, run, task->job);
    for (int i = 0; i < COORDINATES; i++) {
        ROW(highest[i]) = -INFINITY, ROW(lowest[i]) = INFINITY;
        ROW(record[2 * i]) = -INFINITY, ROW(record[2 * i + 1]) = INFINITY;
        ROW(sum[i]) = ROW(square[i]) = 0.0;
    }
    for (int r = 0; r < RECORDS; r++) ROW(record_step[r]) = ROW(record_nearby[r]) = 0.0;
    ROW(time) = task->begin;
    ROW(wish) = ROW(measured) = ROW(measured_time) = ROW(steps) = ROW(rejections) = ROW(sample) = 0.0;
    ROW(old_size) = FIRST_SIZE;
    ROW(run) = (double)run;
    if (sample_time(task, run, 0.0) <= task->begin) {
        for (int i = 0; i < STATES; i++) keep_sample(task->job, run, 0, i, ROW(state[i]));
        ROW(sample) = 1.0;
    }
    ROW(sample_time) = sample_time(task, run, ROW(sample));
}

typedef struct {
    Pack *packs;
    Queue queue;
    int64_t run[LANES], piece[LANES]; /* in each lane; -1 where none is */
    int64_t waiting, last, running, ended;
} Floor;

/* A lane at the end of a piece, or where no step is resolved. */
static void leave(Floor *floor, int lane, Pack *p, int k, const Task *task)
{
    queue_records(&floor->queue, p, k);
    int lost = ROW(leaves) > 1.5;
    if (!lost && floor->piece[lane] < task->job->piece_count - 1) {
        open_piece(p, k, floor->run[lane], ++floor->piece[lane], task);
        return;
    }
    if (ROW(measured) > 0.5) ROW(measured_time) += ROW(time) - ROW(drives.start);
    for (int i = 0; i < STATES; i++) ROW(point[i]) = ROW(state[i]); /* a rejected step has left something else there */
    vec room = room_of(p->point, p->input, p->constant);
    int status = lost ? kind_of_failure(LANE(room, k), ROW(room_at_rest)) : DELAGRANGE_COMPLETED;
    keep(p, k, floor->run[lane], task, status, ROW(time));
    floor->run[lane] = -1, floor->running--, floor->ended++;
}

/* The next run that waits, into a lane. */
static void enter(Floor *floor, int lane, Pack *p, int k, const Task *task)
{
    for (; floor->run[lane] < 0 && floor->waiting < floor->last; floor->waiting++) {
        seat(p, k, floor->waiting, task);
        if (holds(kept(p->point, p->input, p->constant, &task->limits), k)) {
            floor->run[lane] = floor->waiting, floor->piece[lane] = 0, floor->running++;
            open_piece(p, k, floor->waiting, 0, task);
        } else {
            int status = kind_of_loss(p->point, p->input, p->constant, &task->limits, k);
            keep(p, k, floor->waiting, task, status, task->begin);
            floor->ended++;
        }
    }
    if (floor->run[lane] < 0) ROW(step) = 0.0, ROW(stop) = INFINITY;
}

static void change_seats(Floor *floor, const Task *task)
{
    const delagrange_runs *job = task->job;
    for (int lane = 0; lane < LANES; lane++) {
        Pack *p = floor->packs + lane / WIDTH;
        int k = lane % WIDTH;
        if (floor->run[lane] >= 0 && ROW(leaves) > 0.5) leave(floor, lane, p, k, task);
        if (floor->run[lane] < 0) enter(floor, lane, p, k, task);
    }
    begin_steps(floor->packs, PACKS, task->vibrates);
    for (int lane = 0; lane < LANES; lane++) {
        Pack *p = floor->packs + lane / WIDTH;
        int k = lane % WIDTH;
        if (ROW(fresh) > 0.5 && ROW(wish) == 0.0) ROW(wish) = first_step(p, k, job->rtol, job->atol, task->duration);
        if (ROW(fresh) > 0.5) {
            vec step = step_from(p->time, p->wish, p->stop);
            ROW(step) = LANE(step, k);
        }
        ROW(fresh) = 0.0;
    }
}

/* What the marks of a lane ask for; whether its run has ended. */
static int see_to(Floor *floor, int lane, Pack *p, int k, const Task *task)
{
    ROW(kind) = ROW(flag);
    if (ROW(flag) < TURN + 0.5) {
        settle(&floor->queue, p, k);
        return 0;
    }
    enqueue(&floor->queue, p, k);
    if (ROW(flag) > LOSS - 0.5) {
        queue_records(&floor->queue, p, k);
        floor->run[lane] = -1, floor->running--, floor->ended++;
        return 1;
    }
    while (ROW(sample_time) <= ROW(end)) {
        ROW(sample) += 1.0;
        ROW(sample_time) = sample_time(task, floor->run[lane], ROW(sample));
    }
    return 0;
}

/* One step of every lane; whether a seat has to change. Loop after loop, so that the packs' divisions overlap. */
static int step_all(Floor *floor, const Task *task)
{
    const delagrange_runs *job = task->job;
    Pack *packs = floor->packs;
    mask marked[PACKS];
    int changed = 0;
    take_stages(packs, PACKS, task->vibrates, job->averages != 0);
    for (int n = 0; n < PACKS; n++) estimate_error(packs + n, job->rtol, job->atol);
    for (int n = 0; n < PACKS; n++) marked[n] = mark(packs + n, task->doubt, job->rtol, job->atol, &task->limits);
    for (int n = 0; n < PACKS; n++)
        for (int k = 0; any(marked[n]) && k < WIDTH; k++) {
            int lane = n * WIDTH + k;
            if (holds(marked[n], k) && floor->run[lane] >= 0) changed |= see_to(floor, lane, packs + n, k, task);
        }
    for (int n = 0; n < PACKS; n++) changed |= control(packs + n, task->duration);
    for (int n = 0; n < PACKS && job->averages; n++) take_averages(packs + n);
    return changed;
}

static double done(const Floor *floor, const Task *task)
{
    double total = (double)floor->ended;
    for (int lane = 0; lane < LANES; lane++) {
        const Pack *p = floor->packs + lane / WIDTH;
        if (floor->run[lane] >= 0) total += (LANE(p->time, lane % WIDTH) - task->begin) / task->duration;
    }
    return total;
}

/* An empty floor; rows hold ones, so that a lane without a run computes with numbers. */
static Floor opened(void *workspace, int64_t first, int64_t last)
{
    Floor floor = {.packs = aligned(workspace), .waiting = first, .last = last};
    floor.queue = (Queue){floor.packs + PACKS, 0};
    for (double *x = (double *)floor.packs; x < (double *)(floor.packs + PACKS + QUEUE_PACKS); x++) *x = 1.0;
    for (int lane = 0; lane < LANES; lane++) floor.run[lane] = -1, floor.piece[lane] = 0;
    for (Pack *p = floor.packs; p < floor.packs + PACKS; p++) p->flag = p->fresh = all(0.0), p->stop = all(INFINITY);
    return floor;
}

void delagrange_integrate(const delagrange_runs *job, int64_t first, int64_t last, double *progress, void *workspace)
{
    double begin = job->pieces[DELAGRANGE_BEGIN];
    double end = job->pieces[DELAGRANGE_PIECE_COLUMNS * (job->piece_count - 1) + DELAGRANGE_END];
    Task task = {job, {job->smallest, job->largest}, begin, end - begin, DOUBT + pow(job->rtol, 0.75), {0}};
    int64_t columns = job->drive_columns;
    find_vibrating(job->drives, job->piece_count, columns, columns == 1 ? 0 : first, columns == 1 ? 1 : last, task.vibrates);
    Floor floor = opened(workspace, first, last);
    int changed = 1;
    for (int64_t turn = 1;; turn++) {
        int over = (job->stop && *job->stop) || (!changed && floor.running == 0);
        if (over) break;
        while (floor.queue.count >= LANES) empty(&floor.queue, &task);
        if (changed) change_seats(&floor, &task);
        changed = floor.running > 0 ? step_all(&floor, &task) : 0;
        if (progress && turn % LOOK == 0) *progress = done(&floor, &task);
    }
    while (floor.queue.count > 0) empty(&floor.queue, &task);
    if (progress) *progress = (double)floor.ended;
}

size_t delagrange_lanes_workspace(void) { return (PACKS + QUEUE_PACKS) * sizeof(Pack) + ALIGNMENT; }

void delagrange_lanes(delagrange_library *library) { describe(library, sizeof(delagrange_runs), LANES); }
