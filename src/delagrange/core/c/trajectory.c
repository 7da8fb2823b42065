/* One run, its state at the times that are asked for from the interpolants of its steps. */
#define WIDTH 1
#define ABREAST 1
#include "library.h"

#include "errors.h"
#include "interpolant.h"

typedef struct {
    Pack pack;
    Limits limits;
    double begin, whole_time;
    int64_t piece, next; /* of the pieces; of the times */
    uint8_t vibrates[INPUT_ROWS];
} Journey;

enum { k = 0 }; /* the only lane */

/* The state at a time, x of the step, into its row; of the time at the start of all, what it begins with. */
static void keep_state(Journey *journey, delagrange_run *job, double x)
{
    Pack *p = &journey->pack;
    vec state[STATES];
    for (int i = 0; i < STATES; i++) state[i] = x > 0.0 ? value_at(p, k, i, x) : ROW(state[i]);
    for (int i = 0; i < STATES; i++) job->states[journey->next * STATES + i] = first(state[i]);
#if ENERGIES
    if (job->energies) {
        vec input[1][INPUT_ROWS], energy[ENERGIES];
        Row row = row_of(p);
        inputs_at(x, row.drives, row.course, journey->vibrates, input);
        energies(state, input[0], p->constant, energy);
        for (int i = 0; i < ENERGIES; i++) job->energies[journey->next * ENERGIES + i] = first(energy[i]);
    }
#endif
    journey->next++;
}

static void open_piece(Journey *journey, const delagrange_run *job)
{
    Pack *p = &journey->pack;
    const double *span = job->pieces + DELAGRANGE_PIECE_COLUMNS * journey->piece;
    const double *drive = job->drives + journey->piece * DELAGRANGE_DRIVE_ROWS * INPUTS;
    p->drives.start = span[DELAGRANGE_BEGIN], p->stop = span[DELAGRANGE_END];
    for (int i = 0; i < INPUTS; i++) {
        p->drives.level[i] = drive[DELAGRANGE_LEVEL * INPUTS + i];
        p->drives.slope[i] = drive[DELAGRANGE_SLOPE * INPUTS + i];
        p->drives.amplitude[i] = drive[DELAGRANGE_AMPLITUDE * INPUTS + i];
        p->drives.frequency[i] = drive[DELAGRANGE_FREQUENCY * INPUTS + i];
        p->drives.phase[i] = drive[DELAGRANGE_PHASE * INPUTS + i];
    }
    p->step = p->wish, p->fresh = 1.0;
    begin_steps(p, 1, journey->vibrates);
    if (p->wish == 0.0) p->wish = first_step(p, k, job->rtol, job->atol, journey->whole_time);
    p->step = step_from(p->time, p->wish, p->stop);
    p->fresh = 0.0;
}

static void end(Journey *journey, delagrange_run *job, int status, double time)
{
    Pack *p = &journey->pack;
    for (int i = 0; i < STATES; i++) job->last_state[i] = p->point[i];
    job->status = status;
    job->status_time = time;
}

static void begin(Journey *journey, delagrange_run *job)
{
    Pack *p = &journey->pack;
    double constant[CONSTANT_ROWS] = {0.0};
    memset(journey, 0, sizeof *journey);
    journey->limits = (Limits){job->smallest, job->largest};
    journey->begin = job->pieces[DELAGRANGE_BEGIN];
    journey->whole_time = job->pieces[DELAGRANGE_PIECE_COLUMNS * (job->piece_count - 1) + DELAGRANGE_END] - journey->begin;
    find_vibrating(job->drives, job->piece_count, 1, 0, 1, journey->vibrates);
    constants(job->parameters, constant);
    for (int i = 0; i < ALL_CONSTANTS; i++) p->constant[i] = constant[i];
    p->room_at_rest = room_at_rest(job->parameters, constant);
    for (int i = 0; i < STATES; i++) p->state[i] = p->point[i] = job->state[i];
    p->time = journey->begin;
    p->old_size = FIRST_SIZE;
    job->begun = 1;
    if (!kept(p->state, p->input, p->constant, &journey->limits)) {
        end(journey, job, kind_of_loss(p->state, p->input, p->constant, &journey->limits, k), journey->begin);
        return;
    }
    open_piece(journey, job);
    if (job->time_count > 0 && job->times[0] <= journey->begin) keep_state(journey, job, 0.0);
}

/* What is asked for in an accepted step, up to a part of it where the run is lost. */
static void look_into(Journey *journey, delagrange_run *job, int lost)
{
    Pack *p = &journey->pack;
    double part = 1.0, last = p->end;
    int asked = journey->next < job->time_count && job->times[journey->next] <= p->end;
    if (!lost && !asked) return;
    interpolate(p, 1, journey->vibrates);
    if (lost) {
        part = crossing(p, k, &journey->limits);
        last = p->time + part * p->step;
    }
    for (; journey->next < job->time_count && job->times[journey->next] <= last;) {
        double x = (job->times[journey->next] - p->time) / p->step;
        keep_state(journey, job, x < part ? x : part);
    }
    if (lost) {
        p->steps += 1.0;
        end(journey, job, kind_of_loss(p->point, p->input, p->constant, &journey->limits, k), last);
    }
}

/* The end of a piece, or of all; or no step is resolved. */
static void leave(Journey *journey, delagrange_run *job)
{
    Pack *p = &journey->pack;
    for (int i = 0; i < STATES; i++) p->point[i] = p->state[i]; /* a rejected step has left something else there */
    if (p->leaves > 1.5) {
        end(journey, job, kind_of_failure(first(room_of(p->point, p->input, p->constant)), p->room_at_rest), p->time);
    } else if (journey->piece == job->piece_count - 1) {
        for (; journey->next < job->time_count;) /* a time beyond the end by rounding */
            keep_state(journey, job, 0.0);
        end(journey, job, DELAGRANGE_COMPLETED, p->time);
    } else {
        journey->piece++;
        open_piece(journey, job);
    }
}

static void step(Journey *journey, delagrange_run *job)
{
    Pack *p = &journey->pack;
    take_stages(p, 1, journey->vibrates, 0);
    estimate_error(p, job->rtol, job->atol);
    p->end = pick(upto(p->stop - p->time, p->step), p->stop, p->time + p->step);
    if (p->error <= 1.0) look_into(journey, job, !kept(p->point, p->input, p->constant, &journey->limits));
    if (job->status != DELAGRANGE_INTERRUPTED) return;
    if (control(p, journey->whole_time)) leave(journey, job);
}

void delagrange_trajectory(delagrange_run *job, int64_t budget, void *workspace)
{
    Journey *journey = aligned(workspace);
    if (!job->begun) begin(journey, job);
    for (; budget > 0 && job->status == DELAGRANGE_INTERRUPTED; budget--) step(journey, job);
    job->steps = (int64_t)journey->pack.steps;
    job->rejections = (int64_t)journey->pack.rejections;
    if (job->status == DELAGRANGE_INTERRUPTED) job->status_time = journey->pack.time;
}

size_t delagrange_trajectory_workspace(void) { return sizeof(Journey) + ALIGNMENT; }

void delagrange_one(delagrange_library *library) { describe(library, sizeof(delagrange_run), 1); }
