/* WIDTH doubles side by side, and the few things that are done with them: all that differs from machine to machine.
 *
 * WIDTH is 8, 4, 2 or 1; 1 is plain C99. Every width gives the same bits, as long as the processor fuses a multiply
 * and an add: `madd` is the only place where that is done, and a compiler must be kept from doing it elsewhere
 * (-ffp-contract=off). Without such a processor `madd` rounds twice, and the results are a second family, which differs
 * from the first by less than any tolerance. Comparisons are ordered: with a NaN they are false.
 */
#ifndef DELAGRANGE_VECTORS_H
#define DELAGRANGE_VECTORS_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifndef WIDTH
#if !defined(__GNUC__)
#define WIDTH 1
#elif defined(__AVX512F__) && defined(__AVX512DQ__)
#define WIDTH 8
#elif defined(__AVX__)
#define WIDTH 4
#else
#define WIDTH 2
#endif
#endif

#if defined(__FMA__) || defined(__aarch64__) || defined(_M_ARM64)
#define FUSES 1 /* a multiply and an add with one rounding */
#else
#define FUSES 0
#endif

#define ALIGNMENT 64 /* [bytes], of the widest vector */

#if WIDTH == 1

#define INLINE static inline
#define NOINLINE static
typedef double vec;
typedef int64_t mask; /* 0 or -1 */
typedef uint64_t bits;
INLINE vec all(double x) { return x; }
INLINE double first(vec x) { return x; }
INLINE bits as_bits(vec x) { bits y; memcpy(&y, &x, sizeof y); return y; }
INLINE vec as_vec(bits x) { vec y; memcpy(&y, &x, sizeof y); return y; }
INLINE mask below(vec a, vec b) { return -(mask)(a < b); }
INLINE mask upto(vec a, vec b) { return -(mask)(a <= b); }
INLINE mask negative(bits x) { return -(mask)(x >> 63); }
INLINE int any(mask m) { return m != 0; }
INLINE int holds(mask m, int k) { (void)k; return m != 0; }
INLINE vec pick(mask m, vec a, vec b) { return m ? a : b; }
INLINE vec vec_sqrt(vec x) { return sqrt(x); }
#if FUSES
INLINE vec madd(vec a, vec b, vec c) { return fma(a, b, c); }
#else
INLINE vec madd(vec a, vec b, vec c) { return a * b + c; }
#endif

#else

#ifdef DELAGRANGE_SMALL /* slow code that is soon compiled, for sanitizers */
#define INLINE static inline
#else
#define INLINE static inline __attribute__((always_inline))
#endif
#define NOINLINE static __attribute__((noinline))
typedef double vec __attribute__((vector_size(8 * WIDTH), may_alias));
typedef uint64_t bits __attribute__((vector_size(8 * WIDTH), may_alias));
INLINE vec all(double x) { return x - (vec){0}; }
INLINE double first(vec x) { return x[0]; }
INLINE bits as_bits(vec x) { return (bits)x; }
INLINE vec as_vec(bits x) { return (vec)x; }
INLINE vec vec_sqrt(vec x) { for (int k = 0; k < WIDTH; k++) x[k] = sqrt(x[k]); return x; }

#if defined(__FMA__) || defined(__AVX512F__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#if WIDTH == 8 && defined(__AVX512DQ__)
#define OWN_MASKS /* the processor's, which compilers do not find by themselves */
#define OWN_LIMITS
typedef uint8_t mask;
INLINE mask below(vec a, vec b) { return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ); }
INLINE mask upto(vec a, vec b) { return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LE_OQ); }
INLINE mask negative(bits x) { return _mm512_movepi64_mask((__m512i)x); }
INLINE int any(mask m) { return m != 0; }
INLINE int holds(mask m, int k) { return m >> k & 1; }
INLINE vec pick(mask m, vec a, vec b) { return (vec)_mm512_mask_blend_pd(m, (__m512d)b, (__m512d)a); }
INLINE vec smaller(vec a, vec b) { return (vec)_mm512_min_pd((__m512d)a, (__m512d)b); }
INLINE vec larger(vec a, vec b) { return (vec)_mm512_max_pd((__m512d)a, (__m512d)b); }
#endif

#ifndef OWN_MASKS
typedef int64_t mask __attribute__((vector_size(8 * WIDTH), may_alias)); /* 0 or -1 */
INLINE mask below(vec a, vec b) { return (mask)(a < b); }
INLINE mask upto(vec a, vec b) { return (mask)(a <= b); }
INLINE mask negative(bits x) { return (mask)x < 0; }
INLINE int any(mask m) { int64_t some = 0; for (int k = 0; k < WIDTH; k++) some |= m[k]; return some != 0; }
INLINE int holds(mask m, int k) { return m[k] != 0; }
INLINE vec pick(mask m, vec a, vec b) { return (vec)((m & (mask)a) | (~m & (mask)b)); }
#endif

#if WIDTH == 8 && defined(__AVX512F__)
INLINE vec madd(vec a, vec b, vec c) { return (vec)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c); }
#elif WIDTH == 4 && defined(__FMA__)
INLINE vec madd(vec a, vec b, vec c) { return (vec)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c); }
#elif WIDTH == 2 && defined(__FMA__)
INLINE vec madd(vec a, vec b, vec c) { return (vec)_mm_fmadd_pd((__m128d)a, (__m128d)b, (__m128d)c); }
#elif WIDTH == 2 && defined(__aarch64__)
INLINE vec madd(vec a, vec b, vec c) { return (vec)vfmaq_f64((float64x2_t)c, (float64x2_t)a, (float64x2_t)b); }
#elif FUSES
INLINE vec madd(vec a, vec b, vec c) { for (int k = 0; k < WIDTH; k++) c[k] = fma(a[k], b[k], c[k]); return c; }
#else
INLINE vec madd(vec a, vec b, vec c) { return a * b + c; }
#endif

#endif

#ifndef OWN_LIMITS /* with a NaN, the second */
INLINE vec smaller(vec a, vec b) { return pick(below(a, b), a, b); }
INLINE vec larger(vec a, vec b) { return pick(below(b, a), a, b); }
#endif

INLINE vec maddc(double a, vec b, vec c) { return madd(all(a), b, c); }
INLINE vec magnitude(vec x) { return as_vec(as_bits(x) & 0x7fffffffffffffffULL); }

/* Smaller of the two, or NaN where one of them is. */
INLINE vec smaller_known(vec a, vec b) { return pick(upto(a, a), smaller(a, b), a); }

/* x to the nearest whole number, for sizes below 2^51: what is added to 1.5 * 2^52 is rounded to one. */
#define WHOLES 6755399441055744.0
INLINE vec whole(vec x) { return (x + WHOLES) - WHOLES; }

/* Lane k of a vector that stands in memory. */
#define LANE(row, k) (((double *)&(row))[k])

/* What the equations of some materials need beyond arithmetic, lane by lane from the mathematical library. */
#define BY_LANES(name, function)                                                                                     \
    INLINE vec name(vec x)                                                                                           \
    {                                                                                                                \
        for (int k = 0; k < WIDTH; k++) LANE(x, k) = function(LANE(x, k));                                           \
        return x;                                                                                                    \
    }

BY_LANES(vec_exp, exp)
BY_LANES(vec_log, log)
BY_LANES(vec_sin, sin)
BY_LANES(vec_cos, cos)
BY_LANES(vec_tan, tan)
BY_LANES(vec_sinh, sinh)
BY_LANES(vec_cosh, cosh)
BY_LANES(vec_tanh, tanh)

INLINE vec vec_pow(vec x, vec y)
{
    for (int k = 0; k < WIDTH; k++) LANE(x, k) = pow(LANE(x, k), LANE(y, k));
    return x;
}

#endif
