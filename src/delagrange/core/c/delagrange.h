/* Delagrange's core: membranes integrated by compiled code, from C or from any language that can call it.
 *
 * One library holds one model. It is made of a source of this folder and the header of the model, which is emitted
 * beside its Python module:
 *
 *     cc -std=c99 -O2 -ffp-contract=off -DDELAGRANGE_MODEL='"equal_biaxial.h"' -Igenerated -Icore lanes.c ... -lm
 *
 * lanes.c       `delagrange_integrate`: many runs side by side; extrema, averages, samples
 * trajectory.c  `delagrange_trajectory`: one run, its state at the times that are asked for
 * tangents.c    `delagrange_travel`: one run and its variational equations
 *
 * Each can be taken without the others. -march=native, or a level as x86-64-v3, makes it fast; results are the same
 * bits for every compiler, width and level of optimisation, as long as the processor fuses multiply and add (vectors.h).
 *
 * Nothing is allocated, no state is kept, nothing is printed: arrays and workspace are the caller's, who answers for
 * their sizes. Calls with workspaces and results of their own may go on at the same time. SI units throughout. Arrays
 * are of doubles, row after row, their shapes given as (rows, columns); the names of sizes are those that the header of
 * a model defines: STATES, COORDINATES (the first of the state; their rates follow), INPUTS, PARAMETERS, ENERGIES.
 *
 * What a header has to hold: it is included twice. At first it defines MODEL_NAME, MODEL_DIGEST and the sizes, with
 * CONSTANTS (how many constants the rates and limits need), ALL_CONSTANTS and HAS_VALIDITY; then the functions:
 *
 *     constants(parameter, constant)       what of the equations does not move, once a run; of plain doubles
 *     reference(parameter, state)          the state at rest, (STATES,); of plain doubles
 *     rates(state, input, constant, rate)  rate of change of the state, for ABREAST vectors at once (abreast.h)
 *     stretches(state, input, constant, least, most)  least principal and largest in-plane stretch [1]
 *     validity(state, input, constant, room)          if HAS_VALIDITY: what is left to the limits of the strain energies
 *                                          [1], positive where all hold
 *     motion(groups, state, input, constant, tangent, push, rate, moved, trace)  the rates; for each group of WIDTH
 *                                          columns of the tangent (STATES), Jacobian by the state times them and Jacobian
 *                                          by the inputs times `push` (INPUTS); and the trace of the former
 *     energies(state, input, constant, energy)        if ENERGIES: as the comment of the header says [J and W]
 */
#ifndef DELAGRANGE_H
#define DELAGRANGE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define DELAGRANGE_API __declspec(dllexport)
#elif defined(__GNUC__)
#define DELAGRANGE_API __attribute__((visibility("default")))
#else
#define DELAGRANGE_API
#endif

/* What has become of a run. */
enum {
    DELAGRANGE_COMPLETED,   /* all of its time was integrated */
    DELAGRANGE_COLLAPSED,   /* a principal stretch fell below the smallest allowed */
    DELAGRANGE_DIVERGED,    /* an in-plane stretch passed the largest allowed */
    DELAGRANGE_INTERRUPTED, /* it has not ended */
    DELAGRANGE_LOCKED,      /* a strain energy ceased to hold, or no step was resolved next to where it does */
    DELAGRANGE_UNRESOLVED   /* no step was resolved any more */
};

/* Rows of the numbers of a drive: level + slope * (t - start) + amplitude * sin(2 pi (frequency * t + phase)), t the
 * time [s], `start` that of the piece of time, phase in turns. */
enum { DELAGRANGE_LEVEL, DELAGRANGE_SLOPE, DELAGRANGE_AMPLITUDE, DELAGRANGE_FREQUENCY, DELAGRANGE_PHASE };
#define DELAGRANGE_DRIVE_ROWS 5

/* Columns of a piece of time: from where to where [s], and 1 where extrema and averages are taken, else 0. */
enum { DELAGRANGE_BEGIN, DELAGRANGE_END, DELAGRANGE_MEASURED };
#define DELAGRANGE_PIECE_COLUMNS 3

/* What a library is of. */
typedef struct {
    size_t size; /* of this structure [bytes], and of the job of the library: a caller who knows others must not call */
    size_t job_size;
    const char *model, *digest;
    int64_t states, coordinates, inputs, parameters, energies, lanes; /* `lanes`: how many runs advance side by side */
} delagrange_library;

/* Many runs. Column `run` of an array of `runs` columns belongs to run `run`. */
typedef struct {
    int64_t runs;
    const double *parameters;   /* (PARAMETERS, parameter_columns) */
    int64_t parameter_columns;  /* `runs`, or 1 where all have them in common */
    const double *state;        /* (STATES, runs), where each begins */
    const double *pieces;       /* (piece_count, PIECE_COLUMNS), one after the other; between them drives may jump */
    const double *drives;       /* (piece_count, DRIVE_ROWS, INPUTS, drive_columns) */
    int64_t piece_count, drive_columns; /* `drive_columns`: `runs`, or 1 */
    double rtol;                /* of the local error */
    const double *atol;         /* (STATES,), in the unit of each */
    double smallest, largest;   /* principal stretch and in-plane stretch [1] beyond which a run is lost */
    int64_t averages;           /* not 0: take mean and mean square */
    int64_t sample_count;       /* samples a run */
    const double *first_sample, *sample_spacing; /* (runs,) [s]; not needed without samples */
    double *samples;            /* (sample_count, STATES, runs), to be filled with NaN before */
    double *maximum, *minimum;  /* (COORDINATES, runs), filled with -inf and inf */
    double *mean, *mean_square; /* (COORDINATES, runs) */
    double *last_state;         /* (STATES, runs), at the end or at the loss */
    int64_t *status;            /* (runs,), filled with INTERRUPTED */
    double *status_time;        /* (runs,) [s], when the run ended */
    int64_t *steps, *rejections; /* (runs,) */
    const volatile int8_t *stop; /* not 0 from elsewhere: end early; or NULL */
} delagrange_runs;

DELAGRANGE_API void delagrange_lanes(delagrange_library *library);
DELAGRANGE_API size_t delagrange_lanes_workspace(void); /* [bytes] */

/* Integrate the runs `first` to `last` (not included). `progress`: how many runs' worth of time is done, kept up to
 * date; or NULL. */
DELAGRANGE_API void delagrange_integrate(const delagrange_runs *job, int64_t first, int64_t last, double *progress,
                                         void *workspace);

/* One run. It goes on where it was when it is called again with the same workspace. */
typedef struct {
    int64_t begun;              /* 0 at first */
    const double *parameters;   /* (PARAMETERS,) */
    const double *state;        /* (STATES,), where it begins */
    const double *pieces;       /* (piece_count, PIECE_COLUMNS) */
    const double *drives;       /* (piece_count, DRIVE_ROWS, INPUTS) */
    int64_t piece_count;
    double rtol;
    const double *atol;         /* (STATES,) */
    double smallest, largest;
    int64_t time_count;
    const double *times;        /* (time_count,) [s], increasing, from the first to the last of the pieces */
    double *states;             /* (time_count, STATES), filled with NaN: those after a loss are left */
    double *energies;           /* (time_count, ENERGIES), filled with NaN; or NULL */
    double *last_state;         /* (STATES,), at the end or at the loss */
    int64_t status;             /* INTERRUPTED while there is more to do */
    double status_time;         /* [s], how far it has come */
    int64_t steps, rejections;
} delagrange_run;

DELAGRANGE_API void delagrange_one(delagrange_library *library);
DELAGRANGE_API size_t delagrange_trajectory_workspace(void);

/* At most `budget` steps more; the status says whether that was enough. */
DELAGRANGE_API void delagrange_trajectory(delagrange_run *job, int64_t budget, void *workspace);

/* One run and its tangent: columns whose rate is the Jacobian times them, and what a number of a drive adds that a
 * column is the derivative by. Errors are in units of `tolerance` times `weights`, lengths in units of these. It goes on
 * as a run does. */
typedef struct {
    int64_t begun;
    const double *parameters;   /* (PARAMETERS,) */
    const double *state;        /* (STATES,), at the first of the times */
    const double *drives;       /* (DRIVE_ROWS, INPUTS), at all times */
    double start;               /* [s], from which their slopes are counted */
    const double *weights;      /* (STATES,), typical sizes of the state variables */
    double tolerance, smallest, largest;
    int64_t time_count;
    const double *times;        /* (time_count,) [s], increasing */
    int64_t column_count;
    const double *columns;      /* (column_count, STATES), of the tangent at the first of the times */
    const int64_t *sources;     /* (column_count, 2), input and row of its drive that a column is the derivative by, the
                                   phase as an angle [rad]; or -1, -1 */
    int64_t normalise;          /* not 0: make the columns orthonormal in units of the weights at each time but the first */
    double *states;             /* (time_count, STATES), filled with NaN but for the first row */
    double *growth;             /* (time_count - 1, column_count), if `normalise`: logarithms of the lengths, filled with NaN */
    double *divergence;         /* (time_count,), integral of the trace, 0 at first and then filled with NaN */
    double *maximum, *minimum;  /* (COORDINATES,), filled with the coordinates at the first of the times */
    double *last_state;         /* (STATES,), at the end or at the loss */
    double *last_columns;       /* (column_count, STATES), there */
    int64_t status;             /* INTERRUPTED while there is more to do */
    double status_time;         /* [s] */
    int64_t steps, rejections;
} delagrange_tangent;

DELAGRANGE_API void delagrange_tangents(delagrange_library *library);
DELAGRANGE_API size_t delagrange_tangents_workspace(int64_t column_count);
DELAGRANGE_API void delagrange_travel(delagrange_tangent *job, int64_t budget, void *workspace);

#ifdef __cplusplus
}
#endif

#endif
