/* The C compiler lays structs out as layout.h says, which Rust has written. Compiling it is the test. */

#include "swiftprox/batch.h"
#include "swiftprox/compound.h"
#include "swiftprox/draw.h"
#include "swiftprox/geometry.h"
#include "swiftprox/ground.h"
#include "swiftprox/process.h"
#include "swiftprox/replay.h"
#include "swiftprox/scene.h"
#include "swiftprox/sets.h"
#include "swiftprox/tuning.h"
#include "swiftprox/verify.h"

#if SIZE_MAX != 0xffffffffffffffff
#error "layout.h is that of pointers with 64 bits"
#endif

#define STRUCT(type, size, alignment) \
    _Static_assert(sizeof(type) == (size), "the size of " #type); \
    _Static_assert(_Alignof(type) == (alignment), "the alignment of " #type);
#define MEMBER(type, member, offset, size) \
    _Static_assert(offsetof(type, member) == (offset), "where " #type "." #member " stands"); \
    _Static_assert(sizeof(((type *)0)->member) == (size), "the size of " #type "." #member);

#include "layout.h"

int main(void)
{
    return 0;
}
