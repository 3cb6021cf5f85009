/* SWIFT_Scene: writing the files of SWIFT++'s decomposer. */
#ifndef SWIFT_LEGACY_SCENE_SAVING_H
#define SWIFT_LEGACY_SCENE_SAVING_H

#include "../SWIFT.h"
#include "hull_tree_writing.h"

namespace swift_legacy {

/* Opens a file to write, in the words of old where that fails. */
inline bool open_to_write(const char* filename, const char* what, std::ofstream& stream)
{
    if (filename == NULL) {
        report("Error: Invalid filename given to write " + std::string(what));
        return false;
    }
    stream.open(filename, std::ios::out | std::ios::binary);
    if (!stream) {
        report("Error: file could not be opened for writing \"" + std::string(filename) + "\"");
        return false;
    }
    return true;
}

inline bool write_whole(std::ofstream& stream, const char* filename, const std::string& bytes)
{
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        report("Error: file could not be written whole, is the disk full? \"" + std::string(filename) + "\"");
        return false;
    }
    return true;
}

} // namespace swift_legacy

/* Empty, or why the object cannot be written. */
inline std::string SWIFT_Scene::decompose(int id, swift_legacy::Decomposition& decomposition) const
{
    const swift_legacy::Object& object = objects_[id];
    if (object.parts.size() != 1) {
        return "a file of the decomposer has one object, not " + swift_legacy::text(object.parts.size()) + " pieces with numbers";
    }
    return swift_legacy::DecompositionBuilder(object.parts[0]).build(decomposition);
}

inline bool SWIFT_Scene::Save_Decomposition_File(const char* filename, int id) const
{
    const char* const method = "Save_Decomposition_File";
    if (!has_object(id, method)) {
        return false;
    }
    swift_legacy::Decomposition decomposition;
    const std::string fault = decompose(id, decomposition);
    if (!fault.empty()) {
        swift_legacy::report(swift_legacy::about_piece(method, id, 0) + fault);
        return false;
    }
    std::ofstream stream;
    return swift_legacy::open_to_write(filename, "decomp", stream) &&
           swift_legacy::write_whole(stream, filename, swift_legacy::written_decomposition(decomposition));
}

inline bool SWIFT_Scene::Save_Hierarchy_File(const char* filename, int id) const
{
    const char* const method = "Save_Hierarchy_File";
    if (!has_object(id, method)) {
        return false;
    }
    swift_legacy::Decomposition decomposition;
    swift_legacy::HullTree tree;
    std::string bytes, fault = decompose(id, decomposition);
    if (fault.empty()) {
        fault = tree.build(decomposition);
    }
    if (fault.empty()) {
        fault = swift_legacy::HullTreeWriter(decomposition, tree).write(bytes);
    }
    if (!fault.empty()) {
        swift_legacy::report(swift_legacy::about_piece(method, id, 0) + fault);
        return false;
    }
    std::ofstream stream;
    return swift_legacy::open_to_write(filename, "model", stream) && swift_legacy::write_whole(stream, filename, bytes);
}

#endif
