/* Files of SWIFT++'s decomposer: objects of several convex pieces. */
#ifndef SWIFT_LEGACY_PIECE_FILES_H
#define SWIFT_LEGACY_PIECE_FILES_H

#include "decomposition_files.h"
#include "file_dispatcher.h"
#include "hull_tree_files.h"

namespace swift_legacy {

enum PieceFileResult { PIECE_FILE_NONE, PIECE_FILE_READ, PIECE_FILE_REFUSED };

/* The pieces of a file, before any transform. PIECE_FILE_NONE: it is of another kind. Refused after a message. */
inline PieceFileResult pieces_from_file(const char* filename, std::vector<Mesh>& pieces)
{
    std::ifstream stream;
    if (!open_file(filename, stream)) {
        return PIECE_FILE_REFUSED;
    }
    const std::string word = first_word(stream);
    const bool is_tree = word == "Convex_Hierarchy";
    if (!is_tree && word != "Convex_Decomposition") {
        return PIECE_FILE_NONE;
    }
    const std::string fault = is_tree ? read_hull_tree(stream, pieces) : read_decomposition(stream, pieces);
    if (!fault.empty()) {
        report("Error (" + std::string(filename) + "): the convex " + (is_tree ? "hierarchy" : "decomposition") + " is damaged: " + fault);
        return PIECE_FILE_REFUSED;
    }
    return PIECE_FILE_READ;
}

} // namespace swift_legacy

#endif
