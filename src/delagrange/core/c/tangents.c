/* One run and its variational equations through increasing times. */
#define ABREAST 1
#include "tangent_growth.h"
#include "tangent_state.h"
#include "tangent_turns.h"

/* Vectors of the workspace, a group: state, point, rates, pushes, three for errors, and the lengths. */
#define VECTORS (STATES * (STAGES + 3) + INPUT_ROWS + 4)

INLINE int groups_of(int64_t columns) { return (int)((columns + WIDTH) / WIDTH); }

INLINE vec *scratch_of(const Tangent *t) { return (vec *)(t->push + t->groups); }

static void begin_interval(Tangent *t)
{
    t->since = t->divergence = 0.0;
    for (int64_t column = 0; column < t->columns; column++) t->length[column] = length_of(t, column);
}

/* Places in the workspace, all of it zero at first. */
static void lay_out(Tangent *t, int64_t columns)
{
    memset(t, 0, delagrange_tangents_workspace(columns) - 2 * ALIGNMENT);
    t->columns = columns;
    t->groups = groups_of(columns);
    Matrix next = (Matrix)aligned(t + 1);
    Matrix *matrices[] = {&t->state, &t->point};
    for (int n = 0; n < 2; n++, next += t->groups) *matrices[n] = next;
    for (int stage = 0; stage <= STAGES; stage++, next += t->groups) t->rate[stage] = next;
    t->push = (vec (*)[INPUT_ROWS])next;
    t->length = (double *)(scratch_of(t) + 3 * t->groups);
}

static void begin(Tangent *t, delagrange_tangent *job)
{
    double constant[CONSTANT_ROWS] = {0.0};
    lay_out(t, job->column_count);
    constants(job->parameters, constant);
    for (int i = 0; i < ALL_CONSTANTS; i++) t->constant[i] = all(constant[i]);
    t->room_at_rest = room_at_rest(job->parameters, constant);
    t->limits = (Limits){job->smallest, job->largest};
    t->others = all(1.0);
    LANE(t->others, 0) = 0.0;
    for (int i = 0; i < STATES; i++) {
        t->weight[i] = all(job->weights[i]);
        LANE(t->state[0][i], 0) = job->state[i];
        for (int64_t column = 0; column < t->columns; column++) ENTRY(t->state, column, i) = job->columns[column * STATES + i];
    }
    t->drives.start = all(job->start);
    for (int i = 0; i < INPUTS; i++) {
        t->drives.level[i] = all(job->drives[DELAGRANGE_LEVEL * INPUTS + i]);
        t->drives.slope[i] = all(job->drives[DELAGRANGE_SLOPE * INPUTS + i]);
        t->drives.amplitude[i] = all(job->drives[DELAGRANGE_AMPLITUDE * INPUTS + i]);
        t->drives.frequency[i] = all(job->drives[DELAGRANGE_FREQUENCY * INPUTS + i]);
        t->drives.phase[i] = all(job->drives[DELAGRANGE_PHASE * INPUTS + i]);
    }
    find_vibrating(job->drives, 1, 1, 0, 1, t->vibrates);
    for (int64_t column = 0; column < t->columns; column++)
        if (job->sources[2 * column] >= 0) t->followed[job->sources[2 * column]] = 1;
    t->old_size = FIRST_SIZE;
    t->fresh = 1;
    begin_interval(t);
    job->begun = 1;
}

/* A step short against the time in which state, columns or drives change [s]. */
static double first_step(const Tangent *t, double longest)
{
    double fastest = 1.0 / longest, total = 0.0;
    for (int i = 0; i < STATES; i++) {
        double size = fabs(OWN(t->state, i)), weight = first(t->weight[i]);
        double part = OWN(t->rate[0], i) / (size > weight ? size : weight);
        total += part * part;
    }
    if (sqrt(total) > fastest) fastest = sqrt(total);
    for (int64_t column = 0; column < t->columns; column++) {
        vec moving = lengths(t, t->rate[0], (int)((column + 1) / WIDTH));
        double speed = LANE(moving, (column + 1) % WIDTH) / t->length[column];
        if (t->length[column] > 0.0 && speed > fastest) fastest = speed;
    }
    for (int i = 0; i < INPUTS; i++) {
        double frequency = fabs(first(t->drives.frequency[i]));
        if (first(t->drives.amplitude[i]) != 0.0 && frequency > fastest) fastest = frequency;
    }
    double step = FIRST_STEP / fastest;
    return step > 1e-300 ? step : 1e-300;
}

/* A step that ends at the end of the interval, or leaves room for another that is not much shorter [s]. */
static double fitted(double wish, double since, double length)
{
    double left = length - since;
    if (wish >= left) return left;
    return (since + (wish > 0.5 * left ? 0.5 * left : wish)) - since;
}

static void reject(Tangent *t, delagrange_tangent *job, double error, double whole_time)
{
    job->rejections++;
    t->wish = t->step * first(shrinking_after(size_of(all(error))));
    double time = t->time + t->since, reached = fabs(time) > t->since ? fabs(time) : t->since;
    if (t->wish > first(hopeless(all(reached), whole_time))) return;
    vec state[STATES];
    for (int i = 0; i < STATES; i++) state[i] = all(OWN(t->state, i));
    job->status = kind_of_failure(first(room_of(state, t->input, t->constant)), t->room_at_rest);
    job->status_time = time;
}

/* One that was shortened takes nothing from what was wished for. */
static void choose_next(Tangent *t, double error)
{
    double size = first(size_of(all(error)));
    double wish = t->step * first(growth_after(all(size), all(t->old_size)));
    t->old_size = size;
    t->wish = t->step < t->wish && wish < t->wish ? t->wish : wish;
}

/* Take the end of the step for the start of the next. */
static void take(Tangent *t)
{
    for (int g = 0; g < t->groups; g++)
        for (int i = 0; i < STATES; i++) {
            t->state[g][i] = t->point[g][i];
            t->rate[0][g][i] = t->rate[STAGES][g][i];
        }
    t->trace[0] = t->trace[STAGES];
    t->divergence = t->next_divergence;
    t->since += t->step;
}

static int point_kept(const Tangent *t, vec *state)
{
    for (int i = 0; i < STATES; i++) state[i] = all(OWN(t->point, i));
    return holds(kept(state, t->input, t->constant, &t->limits), 0);
}

/* The step as far as the state is kept. */
static void lose(Tangent *t, delagrange_tangent *job)
{
    vec state[STATES];
    begin_tangent_step(t, last_kept(t));
    advance(t, job->sources);
    evaluate(t, job->sources, 1.0, t->point, STAGES);
    point_kept(t, state);
    job->status = kind_of_loss(state, t->input, t->constant, &t->limits, 0);
    job->status_time = (t->time + t->since) + t->step;
}

static void arrive(Tangent *t, delagrange_tangent *job)
{
    int64_t row = ++t->row;
    for (int i = 0; i < STATES; i++) job->states[row * STATES + i] = OWN(t->state, i);
    job->divergence[row] = job->divergence[row - 1] + t->divergence;
    if (job->normalise) {
        orthonormalise(t, job->growth + (row - 1) * t->columns);
        t->fresh = 1;
    }
    begin_interval(t);
}

static void step(Tangent *t, delagrange_tangent *job)
{
    const double *times = job->times, whole_time = times[job->time_count - 1] - times[0];
    double length = times[t->row + 1] - times[t->row];
    vec state[STATES];
    t->time = times[t->row];
    if (t->fresh) {
        begin_tangent_step(t, 0.0);
        evaluate(t, job->sources, 0.0, t->state, 0);
        t->fresh = 0;
    }
    if (t->wish == 0.0) t->wish = first_step(t, whole_time);
    begin_tangent_step(t, fitted(t->wish, t->since, length));
    advance(t, job->sources);
    double error = tangent_error(t, job->tolerance, scratch_of(t));
    if (!(error <= 1.0)) { /* no number either */
        reject(t, job, error, whole_time);
        return;
    }
    evaluate(t, job->sources, 1.0, t->point, STAGES);
    if (point_kept(t, state)) choose_next(t, error);
    else lose(t, job);
    note_turns(t, job->maximum, job->minimum);
    job->steps++;
    int arrived = t->step == length - t->since;
    take(t);
    if (arrived && job->status == DELAGRANGE_INTERRUPTED) arrive(t, job);
}

static void hand_out(const Tangent *t, delagrange_tangent *job)
{
    for (int i = 0; i < STATES; i++) {
        job->last_state[i] = OWN(t->state, i);
        for (int64_t column = 0; column < t->columns; column++) job->last_columns[column * STATES + i] = ENTRY(t->state, column, i);
    }
}

void delagrange_travel(delagrange_tangent *job, int64_t budget, void *workspace)
{
    Tangent *t = aligned(workspace);
    if (!job->begun) begin(t, job);
    for (; budget > 0 && t->row < job->time_count - 1 && job->status == DELAGRANGE_INTERRUPTED; budget--) step(t, job);
    if (t->row == job->time_count - 1 && job->status == DELAGRANGE_INTERRUPTED) {
        job->status = DELAGRANGE_COMPLETED;
        job->status_time = job->times[t->row];
    }
    hand_out(t, job);
}

size_t delagrange_tangents_workspace(int64_t columns)
{
    return sizeof(Tangent) + (size_t)groups_of(columns) * VECTORS * sizeof(vec) + 3 * ALIGNMENT;
}

void delagrange_tangents(delagrange_library *library) { describe(library, sizeof(delagrange_tangent), 1); }
