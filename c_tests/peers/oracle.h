/* The judge of disagreements: the program examples/exact_oracle.rs, in exact arithmetic and independent of the library. */
#ifndef ORACLE_H
#define ORACLE_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The truth about one pose. */
struct truth {
    int intersecting;
    double lower; /* the largest double that is not above the distance */
    double upper; /* the smallest double that is not below the distance */
};

/* Runs the program on the poses of a scene with the given numbers; 0 when it fails. */
int oracle_judge(const char *program, const struct scene *scene, const size_t *poses, size_t count,
                 struct truth *truths);

#ifdef __cplusplus
}
#endif

#endif
