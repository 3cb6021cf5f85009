/* As old programs include it: with the macros of SWIFT 1.x. */
#define SWIFT_LEGACY_MIN_MAX
#include <SWIFT.h>

#include "legacy_units.h"

#if !defined(min) || !defined(max)
#error "they were asked for"
#endif

int add_unit_box(SWIFT_Scene* scene)
{
    const SWIFT_Real h = static_cast<SWIFT_Real>(0.5);
    const SWIFT_Real vertices[] = {-h, -h, -h, h, -h, -h, -h, h, -h, h, h, -h, -h, -h, h, h, -h, h, -h, h, h, h, h, h};
    const int faces[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5}, valences[] = {4, 4, 4, 4, 4, 4};
    int id = min(-1, max(-2, -3));
    scene->Add_Convex_Object(vertices, faces, 8, 6, id, DEFAULT_FIXED, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, DEFAULT_SCALE,
                             DEFAULT_BOX_SETTING, DEFAULT_BOX_ENLARGE_REL, DEFAULT_BOX_ENLARGE_ABS, valences,
                             DEFAULT_CUBE_ASPECT_RATIO);
    return id;
}

const void* other_default()
{
    return &DEFAULT_ORIENTATION;
}
