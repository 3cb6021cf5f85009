#include "tune_settings.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* ---- which ---- */

/* Of the size of the bodies. Less is about what exact answers say; more is no distance any more. */
static const double ERRORS[] = {1e-6, 1e-4, 1e-3, 1e-2, 3e-2, 1e-1};

/* What is left of the triangles from one level of detail to the next; what the library's own choice leaves. */
#define DEFAULT_DECIMATION 0.25

static const struct tune_setting DEFAULTS = {.start = SWIFTPROX_START_AUTOMATIC,
                                             .levels = SWIFTPROX_LEVELS_AUTOMATIC,
                                             .hierarchy = SWIFTPROX_HIERARCHY_AUTOMATIC,
                                             .lookup = SWIFTPROX_LOOKUP_AUTOMATIC,
                                             .workers = 1};

struct list {
    struct tune_setting *settings;
    size_t count;
};

static void add(struct list *list, struct tune_setting setting)
{
    if (list->count < TUNE_MOST_SETTINGS) {
        list->settings[list->count++] = setting;
    }
}

/* A setting with each error; verdicts have none. */
static void add_errors(struct list *list, const struct tune_scene *scene, struct tune_setting setting)
{
    for (size_t i = 0; scene->kind != SWIFTPROX_QUERY_KIND_INTERSECTION && i < sizeof ERRORS / sizeof *ERRORS; i++) {
        setting.error = ERRORS[i] * scene->size;
        if (setting.error > 0) {
            add(list, setting);
        }
    }
}

size_t tune_settings(const struct tune_scene *scene, struct tune_setting settings[TUNE_MOST_SETTINGS])
{
    static const swiftprox_start STARTS[] = {SWIFTPROX_START_CACHE, SWIFTPROX_START_TABLE, SWIFTPROX_START_COLD};
    struct list list = {settings, 0};
    struct tune_setting setting = DEFAULTS;
    add(&list, setting);
    add_errors(&list, scene, setting);
    for (size_t i = 0; i < sizeof STARTS / sizeof *STARTS; i++) {
        setting.start = STARTS[i];
        add(&list, setting);
    }
    setting = DEFAULTS;
    if (scene->has_levels || scene->makes_shapes) {
        setting.levels = SWIFTPROX_LEVELS_ALL;
        setting.hierarchy = scene->makes_shapes ? SWIFTPROX_HIERARCHY_QUADRIC : DEFAULTS.hierarchy;
        add(&list, setting);
        /* Depths are not answered by levels. */
        if (scene->kind != SWIFTPROX_QUERY_KIND_CONTACT) {
            add_errors(&list, scene, setting);
        }
    }
    setting = DEFAULTS;
    if (scene->makes_shapes) {
        setting.lookup = SWIFTPROX_LOOKUP_NONE;
        add(&list, setting);
    }
    setting = DEFAULTS;
    for (setting.workers = 2; setting.workers <= scene->workers; setting.workers *= 2) {
        add(&list, setting);
    }
    return list.count;
}

swiftprox_pair_tuning tune_pair_tuning(const struct tune_setting *setting)
{
    swiftprox_pair_tuning tuning = SWIFTPROX_PAIR_TUNING_DEFAULT;
    tuning.start = setting->start;
    tuning.levels = setting->levels;
    return tuning;
}

swiftprox_shape_tuning tune_shape_tuning(const struct tune_setting *setting)
{
    swiftprox_shape_tuning tuning = SWIFTPROX_SHAPE_TUNING_DEFAULT;
    tuning.hierarchy = setting->hierarchy;
    tuning.lookup = setting->lookup;
    tuning.decimation = DEFAULT_DECIMATION;
    return tuning;
}

/* ---- words ---- */

void tune_print_setting(const struct tune_setting *setting)
{
    static const char *const STARTS[] = {"", ", start at the last features", ", start at the tables", ", start afresh"};
    if (setting->error > 0) {
        printf("error %.3g", setting->error);
    } else {
        fputs("exact", stdout);
    }
    fputs(STARTS[setting->start], stdout);
    if (setting->hierarchy == SWIFTPROX_HIERARCHY_QUADRIC) {
        fputs(", shapes with levels", stdout);
    }
    if (setting->levels == SWIFTPROX_LEVELS_ALL) {
        fputs(", through all levels", stdout);
    }
    if (setting->lookup == SWIFTPROX_LOOKUP_NONE) {
        fputs(", shapes without tables", stdout);
    }
    if (setting->workers > 1) {
        printf(", %" PRIu32 " threads", setting->workers);
    }
    putchar('\n');
}

/* ---- code ---- */

static const char *constant_of_start(swiftprox_start start)
{
    static const char *const NAMES[] = {"SWIFTPROX_START_AUTOMATIC", "SWIFTPROX_START_CACHE", "SWIFTPROX_START_TABLE",
                                        "SWIFTPROX_START_COLD"};
    return NAMES[start];
}

/* The query's name behind swiftprox_scene_query_ and SceneView::query_. */
static const char *query_name(const struct tune_scene *scene, const struct tune_setting *setting)
{
    return scene->kind == SWIFTPROX_QUERY_KIND_INTERSECTION ? "intersection"
           : scene->kind == SWIFTPROX_QUERY_KIND_CONTACT    ? "contact"
           : setting->error > 0                             ? "approximate"
                                                            : "distance";
}

static bool tunes_pairs(const struct tune_setting *setting)
{
    return setting->start != DEFAULTS.start || setting->levels != DEFAULTS.levels;
}

static bool tunes_shapes(const struct tune_setting *setting)
{
    return setting->hierarchy != DEFAULTS.hierarchy || setting->lookup != DEFAULTS.lookup;
}

/* The lines that C and C++ have in common: what is set of a structure. */
static void print_tuning_of_shapes(const struct tune_setting *setting, const char *name)
{
    if (setting->hierarchy == SWIFTPROX_HIERARCHY_QUADRIC) {
        printf("%s.hierarchy = SWIFTPROX_HIERARCHY_QUADRIC;\n", name);
    }
    if (setting->lookup == SWIFTPROX_LOOKUP_NONE) {
        printf("%s.lookup = SWIFTPROX_LOOKUP_NONE;\n", name);
    }
}

static void print_tuning_of_pairs(const struct tune_setting *setting)
{
    if (setting->start != DEFAULTS.start) {
        printf("tuning.start = %s;\n", constant_of_start(setting->start));
    }
    if (setting->levels != DEFAULTS.levels) {
        puts("tuning.levels = SWIFTPROX_LEVELS_ALL;");
    }
}

static void print_query(const struct tune_scene *scene, const struct tune_setting *setting)
{
    if (scene->kind != SWIFTPROX_QUERY_KIND_INTERSECTION && isfinite(scene->max_distance)) {
        printf("query.max_distance = %.17g;\n", scene->max_distance);
    }
    if (setting->error > 0) {
        printf("query.absolute_error = %.17g;\n", setting->error);
    }
    if (scene->kind == SWIFTPROX_QUERY_KIND_CONTACT) {
        puts("query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;");
    }
}

void tune_print_c(const struct tune_scene *scene, const struct tune_setting *setting)
{
    puts("#include <swiftprox.h>");
    if (tunes_pairs(setting) || tunes_shapes(setting)) {
        puts("#include <swiftprox/tuning.h>");
    }
    if (tunes_shapes(setting)) {
        puts("\n/* where shapes are made: swiftprox_shape_create_from_mesh(..., &shape_options, ...) */\n"
             "swiftprox_shape_tuning shape_tuning = SWIFTPROX_SHAPE_TUNING_DEFAULT;");
        print_tuning_of_shapes(setting, "shape_tuning");
        puts("swiftprox_shape_options shape_options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;\n"
             "shape_options.tuning = &shape_tuning;");
    }
    if (setting->workers > 1) {
        printf("\n/* where the scene is made: swiftprox_scene_create(&options, &scene) */\n"
               "swiftprox_scene_options options = SWIFTPROX_SCENE_OPTIONS_DEFAULT;\n"
               "options.worker_count = %" PRIu32 ";\n",
               setting->workers);
    }
    puts("\n/* in each step */");
    if (tunes_pairs(setting)) {
        puts("swiftprox_pair_tuning tuning = SWIFTPROX_PAIR_TUNING_DEFAULT;");
        print_tuning_of_pairs(setting);
    }
    puts("swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;");
    print_query(scene, setting);
    if (tunes_pairs(setting)) {
        puts("query.tuning = &tuning;");
    }
    printf("swiftprox_scene_answer answer;\n"
           "const swiftprox_status status = swiftprox_scene_query_%s(scene, &query, &answer);\n",
           query_name(scene, setting));
}

void tune_print_cpp(const struct tune_scene *scene, const struct tune_setting *setting)
{
    puts("#include <swiftprox.hpp>");
    if (tunes_shapes(setting)) {
        puts("\n// where shapes are made: swiftprox::Shape::from_mesh(..., shape_options)\n"
             "swiftprox::ShapeOptions shape_options;");
        print_tuning_of_shapes(setting, "shape_options.tuning");
    }
    if (setting->workers > 1) {
        printf("\n// where the scene is made: swiftprox::Scene scene(options)\n"
               "swiftprox::SceneOptions options;\n"
               "options.worker_count = %" PRIu32 ";\n",
               setting->workers);
    }
    puts("\n// in each step");
    if (tunes_pairs(setting)) {
        puts("swiftprox_pair_tuning tuning = swiftprox::PairTuning{}.to_c();");
        print_tuning_of_pairs(setting);
    }
    puts("swiftprox::SceneQuery query;");
    print_query(scene, setting);
    if (tunes_pairs(setting)) {
        puts("query.tuning = &tuning;");
    }
    printf("const swiftprox_scene_answer answer = scene.query_%s(query);\n", query_name(scene, setting));
}
