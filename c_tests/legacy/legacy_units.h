/* Two translation units of one program that both include SWIFT.h. */
#ifndef LEGACY_UNITS_H
#define LEGACY_UNITS_H

class SWIFT_Scene;

/* Adds a box of side 1; its id. */
int add_unit_box(SWIFT_Scene* scene);

/* Where the other unit sees the default orientation. */
const void* other_default();

#endif
