/* The strict rule, which a macro asks for: convex up to 1e-6 of the diagonal, faces counter-clockwise seen from outside. */
#define SWIFT_LEGACY_STRICT
#include "legacy_solids.h"

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    Messages messages;
    Numbers numbers(7);
    SWIFT_Scene scene(false);
    int id;
    const Solid solid = prism(5, numbers);
    CHECK(!scene.Add_Object(folder.write("strict.poly", solid.file(3)).c_str(), id) && messages.has("its plane"));
    CHECK(scene.Add_Object(folder.write("strict.poly", solid.file(9)).c_str(), id) && messages.take().empty());
    BoxMesh box(1, 1, 1);
    std::reverse(box.triangles, box.triangles + 36);
    CHECK(!box.add(scene, id) && messages.has("inside out"));
    return check_report("legacy_strict");
}
