#include "outline.h"

#include <stdlib.h>

static int left_to_right(const void *one, const void *other)
{
    const struct spot *const a = one, *const b = other;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->z > b->z) - (a->z < b->z);
}

static double turn(struct spot a, struct spot b, struct spot c)
{
    return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
}

/* Puts a spot behind the corners from `first` on, of which those go that it leaves inside. */
static size_t add_corner(struct spot *hull, size_t first, size_t count, struct spot spot)
{
    while (count >= first + 2 && turn(hull[count - 2], hull[count - 1], spot) <= 0) {
        count--;
    }
    hull[count] = spot;
    return count + 1;
}

size_t outline_of(struct spot *spots, size_t count, struct spot *hull)
{
    qsort(spots, count, sizeof *spots, left_to_right);
    size_t corners = 0;
    for (size_t i = 0; i < count; i++) {
        corners = add_corner(hull, 0, corners, spots[i]);
    }
    const size_t rightmost = corners - 1;
    for (size_t i = count - 1; i > 0; i--) {
        corners = add_corner(hull, rightmost, corners, spots[i - 1]);
    }
    return corners;
}
