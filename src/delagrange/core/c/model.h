/* The header of a model, included as it has to be: its sizes, what they need, its equations. */
#ifndef DELAGRANGE_MODEL_H
#define DELAGRANGE_MODEL_H

#ifndef DELAGRANGE_MODEL
#error "say which model: -DDELAGRANGE_MODEL='\"equal_biaxial.h\"'"
#endif
#include DELAGRANGE_MODEL

#define AT_LEAST_ONE(n) ((n) > 0 ? (n) : 1)
#define INPUT_ROWS AT_LEAST_ONE(INPUTS) /* C has no arrays of no length */
#define COORDINATE_ROWS AT_LEAST_ONE(COORDINATES)
#define CONSTANT_ROWS AT_LEAST_ONE(ALL_CONSTANTS)
#define PARAMETER_ROWS AT_LEAST_ONE(PARAMETERS)

#include "abreast.h"
#include "vectors.h"

#include DELAGRANGE_MODEL /* once more, for the equations */

#endif
