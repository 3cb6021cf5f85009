// What the shims of Bullet share.
#ifndef COMPARE_BULLET_H
#define COMPARE_BULLET_H

#include <LinearMath/btTransform.h>

#include <stddef.h>
#include <vector>

// A row-major [R|T].
static inline btTransform bullet_transform(const double *m)
{
    return btTransform(btMatrix3x3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]), btVector3(m[3], m[7], m[11]));
}

// So many of them.
static inline std::vector<btTransform> bullet_transforms(const double *poses, size_t count)
{
    std::vector<btTransform> made;
    for (size_t i = 0; i < count; ++i) {
        made.push_back(bullet_transform(poses + 12 * i));
    }
    return made;
}

#endif
