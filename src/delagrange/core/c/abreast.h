/* Vectors whose instructions alternate: one chain of operations goes on while the other waits for its last result.
 *
 * What is emitted for a model is written for ABREAST vectors at once: `EACH` does something for each of them, numbered
 * by `v`, and `VALUE(name) = ...` gives each a value of that name.
 */
#ifndef DELAGRANGE_ABREAST_H
#define DELAGRANGE_ABREAST_H

#ifndef ABREAST
#define ABREAST 2
#endif

#if defined(__GNUC__) && !defined(__clang__) && !defined(DELAGRANGE_SMALL)
#define UNROLLED _Pragma("GCC unroll 8")
#else
#define UNROLLED
#endif

#define EACH UNROLLED for (int v = 0; v < ABREAST; v++)
#define VALUE(name) vec name[ABREAST]; EACH name[v]

#endif
