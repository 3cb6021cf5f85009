/* Types and numbers that programs written for SWIFT 1.x or SWIFT++ know. */
#ifndef SWIFT_COMMON_H
#define SWIFT_COMMON_H

#include <cfloat>
#include <cstddef>

#include "SWIFT_config.h"

#ifdef SWIFT_USE_FLOAT
typedef float SWIFT_Real;
#else
typedef double SWIFT_Real;
#endif

/* A row-major 3x3 rotation. */
typedef SWIFT_Real SWIFT_Orientation[9];
typedef SWIFT_Real SWIFT_Translation[3];
typedef SWIFT_Real SWIFT_Matrix[9];

/* The kinds of features come first, then what the search of old found. Queries return none of these. */
enum RESULT_TYPE {
    DISJOINT = -3,
    PENETRATION = -2,
    LOCAL_MINIMUM = -1,
    CONTINUE_VV = 0,
    CONTINUE_VE,
    CONTINUE_EV,
    CONTINUE_VF,
    CONTINUE_FV,
    CONTINUE_EE,
    CONTINUE_EF,
    CONTINUE_FE
};

/* No tolerance. */
#ifdef SWIFT_USE_FLOAT
const SWIFT_Real SWIFT_INFINITY = FLT_MAX;
#else
const SWIFT_Real SWIFT_INFINITY = DBL_MAX;
#endif

/* Programs that define these names as macros of their own, before or after, keep theirs. */
#ifndef PI
const SWIFT_Real PI = static_cast<SWIFT_Real>(3.14159265358979323846);
#endif
#ifndef PI_2
const SWIFT_Real PI_2 = static_cast<SWIFT_Real>(1.57079632679489661923);
#endif
#ifndef SQRT2
const SWIFT_Real SQRT2 = static_cast<SWIFT_Real>(1.41421356237309504880);
#endif
#ifndef SQRT1_2
const SWIFT_Real SQRT1_2 = static_cast<SWIFT_Real>(0.70710678118654752440);
#endif

const SWIFT_Real EPSILON1 = static_cast<SWIFT_Real>(1e-1);
const SWIFT_Real EPSILON2 = static_cast<SWIFT_Real>(1e-2);
const SWIFT_Real EPSILON3 = static_cast<SWIFT_Real>(1e-3);
const SWIFT_Real EPSILON4 = static_cast<SWIFT_Real>(1e-4);
const SWIFT_Real EPSILON5 = static_cast<SWIFT_Real>(1e-5);
const SWIFT_Real EPSILON6 = static_cast<SWIFT_Real>(1e-6);
const SWIFT_Real EPSILON7 = static_cast<SWIFT_Real>(1e-7);
const SWIFT_Real EPSILON8 = static_cast<SWIFT_Real>(1e-8);
const SWIFT_Real EPSILON9 = static_cast<SWIFT_Real>(1e-9);
const SWIFT_Real EPSILON10 = static_cast<SWIFT_Real>(1e-10);
const SWIFT_Real EPSILON11 = static_cast<SWIFT_Real>(1e-11);
const SWIFT_Real EPSILON12 = static_cast<SWIFT_Real>(1e-12);
const SWIFT_Real EPSILON13 = static_cast<SWIFT_Real>(1e-13);
const SWIFT_Real EPSILON14 = static_cast<SWIFT_Real>(1e-14);
const SWIFT_Real EPSILON15 = static_cast<SWIFT_Real>(1e-15);

#ifndef SWIFT_min
#define SWIFT_min(a, b) ((a) < (b) ? (a) : (b))
#endif
#ifndef SWIFT_max
#define SWIFT_max(a, b) ((a) > (b) ? (a) : (b))
#endif
inline SWIFT_Real myfabs(SWIFT_Real x)
{
    return x < 0 ? -x : x;
}

#endif
