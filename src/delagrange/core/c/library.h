/* What a library says of itself, and its workspace on the boundary that vectors want. */
#ifndef DELAGRANGE_LIBRARY_H
#define DELAGRANGE_LIBRARY_H

#include "delagrange.h"
#include "model.h"

INLINE void describe(delagrange_library *library, size_t job_size, int lanes)
{
    *library = (delagrange_library){
        sizeof *library, job_size, MODEL_NAME, MODEL_DIGEST, STATES, COORDINATES, INPUTS, PARAMETERS, ENERGIES, lanes,
    };
}

INLINE void *aligned(void *workspace)
{
    return (char *)workspace + (ALIGNMENT - (uintptr_t)workspace % ALIGNMENT) % ALIGNMENT;
}

/* Which inputs have a sine, of drives (pieces, DRIVE_ROWS, INPUTS, columns), in the columns first to last. */
INLINE void find_vibrating(const double *drives, int64_t pieces, int64_t columns, int64_t first, int64_t last,
                           uint8_t *vibrates)
{
    for (int i = 0; i < INPUT_ROWS; i++) vibrates[i] = 0;
    for (int64_t piece = 0; piece < pieces; piece++)
        for (int i = 0; i < INPUTS; i++) {
            const double *amplitude = drives + ((piece * DELAGRANGE_DRIVE_ROWS + DELAGRANGE_AMPLITUDE) * INPUTS + i) * columns;
            for (int64_t column = first; column < last && !vibrates[i]; column++) vibrates[i] = amplitude[column] != 0.0;
        }
}

#endif
