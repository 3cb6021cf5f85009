/* What a query did: the march from two boxes' first features to the nearest ones, in words and, into a file that is named, as an
 * SVG picture. */
#include <stdio.h>
#include <stdlib.h>

#include <swiftprox.h>
#include <swiftprox/draw.h>

/* Ends the program where a call failed. */
static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "drawing: %s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

/* Seen from ahead, somewhat from above and the right. */
static double right_of(const double *place)
{
    return 320 + 150 * (0.906 * place[0] + 0.423 * place[1]);
}

static double below(const double *place)
{
    return 160 - 150 * (-0.224 * place[0] + 0.480 * place[1] + 0.848 * place[2]);
}

static const char *colour_of(swiftprox_draw_kind kind)
{
    return kind == SWIFTPROX_DRAW_KIND_EDGE      ? "#bbb"
           : kind == SWIFTPROX_DRAW_KIND_WITNESS ? "#d33"
           : kind == SWIFTPROX_DRAW_KIND_FEATURE ? "#0072b2"
                                                 : "#56b4e9";
}

static void draw_line(void *svg, swiftprox_draw_kind kind, const double *start, const double *end)
{
    fprintf(svg, "<path stroke=\"%s\" d=\"M%.1f %.1fL%.1f %.1f\"/>\n", colour_of(kind), right_of(start), below(start), right_of(end),
            below(end));
}

static void draw_point(void *svg, swiftprox_draw_kind kind, const double *place)
{
    fprintf(svg, "<circle fill=\"%s\" r=\"3\" cx=\"%.1f\" cy=\"%.1f\"/>\n", colour_of(kind), right_of(place), below(place));
}

static void print_text(void *svg, swiftprox_draw_kind kind, const double *place, const char *text)
{
    (void)svg;
    (void)place;
    printf(kind == SWIFTPROX_DRAW_KIND_WITNESS ? "distance %s\n" : "%s\n", text);
}

static void draw_query(swiftprox_placed object1, swiftprox_placed object2, FILE *svg)
{
    swiftprox_draw draw = SWIFTPROX_DRAW_DEFAULT;
    draw.kinds = 1u << SWIFTPROX_DRAW_KIND_EDGE | 1u << SWIFTPROX_DRAW_KIND_FEATURE | 1u << SWIFTPROX_DRAW_KIND_MARCH |
                 1u << SWIFTPROX_DRAW_KIND_WITNESS;
    draw.user = svg;
    draw.line = svg ? draw_line : NULL; /* nobody draws lines */
    draw.point = svg ? draw_point : NULL;
    draw.text = print_text;
    demand(swiftprox_pair_draw(object1, object2, NULL, &draw));
}

int main(int argc, char **argv)
{
    const double half1[3] = {0.7, 0.4, 0.3}, half2[3] = {0.3, 0.6, 0.5};
    const double turn1[4] = {0.1, 0.3, 0.2, 0.9273618495495704}, turn2[4] = {0.4, -0.1, 0.5, 0.7615773105863909};
    const double place1[3] = {-0.8, 0, 0}, place2[3] = {0.9, 0.1, 0.2};
    const swiftprox_shape *box1, *box2;
    double pose1[12], pose2[12];
    FILE *const svg = argc > 1 ? fopen(argv[1], "w") : NULL;
    if (argc > 1 && !svg) {
        perror(argv[1]);
        return EXIT_FAILURE;
    }
    demand(swiftprox_shape_create_box(half1, 0, &box1));
    demand(swiftprox_shape_create_box(half2, 0, &box2));
    demand(swiftprox_pose_from_quaternion(turn1, place1, pose1));
    demand(swiftprox_pose_from_quaternion(turn2, place2, pose2));
    if (svg) {
        fputs("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" height=\"320\">\n", svg);
    }
    draw_query((swiftprox_placed){box1, pose1}, (swiftprox_placed){box2, pose2}, svg);
    swiftprox_shape_release(box1);
    swiftprox_shape_release(box2);
    return !svg || (fputs("</svg>\n", svg) >= 0 && fclose(svg) == 0) ? EXIT_SUCCESS : EXIT_FAILURE;
}
