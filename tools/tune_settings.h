/* Settings that a scene may be played under: which are worth trying, what they are called, and the code that makes them. */
#ifndef SWIFTPROX_TOOLS_TUNE_SETTINGS_H
#define SWIFTPROX_TOOLS_TUNE_SETTINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <swiftprox.h>
#include <swiftprox/tuning.h>

/* What is known of a scene before anything is tried. */
struct tune_scene {
    swiftprox_query_kind kind;
    double max_distance;  /* of the queries */
    double size;       /* the largest radius of a body that was listed; 0 where none was */
    bool has_levels;   /* some body that was listed has levels of detail */
    bool makes_shapes; /* the shapes are made here, so that how is a setting, too */
    uint32_t workers;  /* at most so many threads */
};

/* A setting; where it differs from the defaults. */
struct tune_setting {
    double error; /* 0: exact */
    swiftprox_start start;
    swiftprox_levels levels;
    swiftprox_hierarchy hierarchy; /* of shapes that are made here */
    swiftprox_lookup lookup;
    uint32_t workers;
};

enum { TUNE_MOST_SETTINGS = 48 };

/* Writes the settings that are worth trying for a scene, the defaults first, and says how many. */
size_t tune_settings(const struct tune_scene *scene, struct tune_setting settings[TUNE_MOST_SETTINGS]);

/* The structures of C. */
swiftprox_pair_tuning tune_pair_tuning(const struct tune_setting *setting);
swiftprox_shape_tuning tune_shape_tuning(const struct tune_setting *setting);

/* Prints the setting in words. */
void tune_print_setting(const struct tune_setting *setting);

/* Prints the code that asks a scene of this kind so. */
void tune_print_c(const struct tune_scene *scene, const struct tune_setting *setting);
void tune_print_cpp(const struct tune_scene *scene, const struct tune_setting *setting);

#endif
