/* The parts of an object that is being added: from meshes, from files, from parts that there are. */
#ifndef SWIFT_LEGACY_PART_BUILDER_H
#define SWIFT_LEGACY_PART_BUILDER_H

#include "decomposer_files.h"
#include "defaults.h"
#include "objects.h"

namespace swift_legacy {

/* Whether SWIFT++ would decompose a mesh of these edges. */
inline bool is_decomposable(const Mesh& mesh)
{
#ifdef SWIFT_ALLOW_BOUNDARY
    (void)mesh;
    return true;
#else
    return surface_fault(mesh).empty();
#endif
}

/* The patches of a surface. False where it is not one; swiftprox_library_last_error_message says why, or what failed. */
inline bool pieces_of_surface(const Mesh& mesh, std::vector<Mesh>& pieces)
{
    if (!is_decomposable(mesh)) {
        return false;
    }
    /* A face of n corners is n - 2 triangles, and no face has fewer than three. */
    const std::size_t capacity = mesh.indices.size() - 2 * mesh.face_count;
    std::vector<uint32_t> corners(3 * capacity + 1), faces(capacity + 1), numbers(capacity + 1);
    swiftprox_decomposition found;
    found.corners = &corners[0];
    found.faces = &faces[0];
    found.pieces = &numbers[0];
    found.capacity = capacity;
    const swiftprox_mesh native = native_mesh(mesh);
    if (swiftprox_mesh_decompose(native, mesh.tolerance, NULL, NULL, &found) != SWIFTPROX_OK) {
        return false;
    }
    SubMesh piece(mesh);
    for (std::size_t t = 0; t < found.triangle_count; ++t) {
        int triangle[3];
        std::copy(&corners[3 * t], &corners[3 * t] + 3, triangle);
        const std::size_t face = faces[t];
        piece.add_triangle(triangle, mesh.face_labels.empty() ? static_cast<int>(face) : mesh.face_labels[face]);
        if (t + 1 == found.triangle_count || numbers[t + 1] != numbers[t]) {
            pieces.push_back(piece.mesh());
            piece.begin();
        }
    }
    return true;
}

/* Whose geometry a piece shares; none where `object` is negative. */
struct CopySource {
    int object;
    int piece;

    CopySource(int copied_object, int copied_piece) : object(copied_object), piece(copied_piece < 0 ? 0 : copied_piece) {}
};

struct PartSettings {
    int box_setting;
    double enlargement_relative;
    double enlargement_absolute;
    LevelOptions levels;

    PartSettings(int setting, SWIFT_Real relative, SWIFT_Real absolute, const LevelOptions& level_options)
        : box_setting(setting), enlargement_relative(relative), enlargement_absolute(absolute), levels(level_options)
    {
    }
};

/* What messages of a failed mesh end in: some add methods say more than others did. */
enum Verbosity { SAYS_WHY, SAYS_CREATION_FAILED };

/* Which method adds, in the words of old, which call most of them Add_Object. */
struct Adder {
    const char* method;
    Verbosity verbosity;
    BoxCentre box_centre;
    bool decomposes;  /* a mesh that is not convex */
    const char* cure; /* what a program can do about a mesh that is refused */

    Adder(const char* name, Verbosity says, BoxCentre centre)
        : method(name), verbosity(says), box_centre(centre), decomposes(false), cure("after Set_Take_Hull(true) the convex hull of the vertices is taken")
    {
    }
};

/* One piece as the caller gives it: its levels in arrays or files, the body first, each with its input transform. */
struct LevelArrays {
    const SWIFT_Real* const* vertices;
    const int* const* faces;
    const int* vertex_counts;
    const int* face_counts;
    const int* const* face_valences;
    const char* const* filenames; /* in place of all of these */
    const SWIFT_Orientation* orientations;
    const SWIFT_Translation* translations;
    const SWIFT_Real* scales;
    int count;

    LevelArrays(const SWIFT_Orientation* orients, const SWIFT_Translation* transs, const SWIFT_Real* factors, int level_count)
        : vertices(NULL), faces(NULL), vertex_counts(NULL), face_counts(NULL), face_valences(NULL), filenames(NULL),
          orientations(orients), translations(transs), scales(factors), count(level_count)
    {
    }

    void from_arrays(const SWIFT_Real* const* vs, const int* const* fs, const int* vn, const int* fn, const int* const* fv)
    {
        vertices = vs, faces = fs, vertex_counts = vn, face_counts = fn, face_valences = fv;
    }

    Transform transform(int level) const
    {
        typedef Identity<void> Default;
        return Transform(orientations == NULL ? Default::orientation : orientations[level],
                         translations == NULL ? Default::translation : translations[level], scales == NULL ? DEFAULT_SCALE : scales[level]);
    }

    /* After the input transform; false after a message. */
    bool read(int level, const std::string& about, Mesh& mesh) const
    {
        if (filenames != NULL) {
            if (!mesh_from_file(filenames[level], mesh)) {
                return false;
            }
        } else {
            const bool are_there = vertices != NULL && faces != NULL && vertex_counts != NULL && face_counts != NULL;
            const std::string fault =
                are_there ? mesh_from_arrays(vertices[level], faces[level], vertex_counts[level], face_counts[level],
                                             face_valences == NULL ? NULL : face_valences[level], mesh)
                          : "no vertices or no faces are given";
            if (!fault.empty()) {
                report(about + fault);
                return false;
            }
        }
        find_tolerance(mesh);
        mesh.transform(transform(level));
        return true;
    }
};

/* What differs from piece to piece; a null array is the default for all. */
struct PieceArrays {
    const int* box_settings;
    const SWIFT_Real* enlargements_relative;
    const SWIFT_Real* enlargements_absolute;
    const int* copied_objects;
    const int* copied_pieces;
    const int* least_triangles;
    const SWIFT_Real* ratios;

    PartSettings settings(int piece) const
    {
        const LevelOptions levels(least_triangles == NULL ? DEFAULT_MIN_TCOUNT : least_triangles[piece],
                                  ratios == NULL ? DEFAULT_QSLIM_TRATIO : ratios[piece]);
        return PartSettings(box_settings == NULL ? BOX_SETTING_DEFAULT : box_settings[piece],
                            enlargements_relative == NULL ? DEFAULT_BOX_ENLARGE_REL : enlargements_relative[piece],
                            enlargements_absolute == NULL ? DEFAULT_BOX_ENLARGE_ABS : enlargements_absolute[piece], levels);
    }

    CopySource source(int piece) const
    {
        return CopySource(copied_objects == NULL ? -1 : copied_objects[piece], copied_pieces == NULL ? -1 : copied_pieces[piece]);
    }
};

/* An array from one of its places on, and one of its entries; null where there is no array. */
template <class Entry> const Entry* from(const Entry* array, int place)
{
    return array == NULL ? NULL : array + place;
}

template <class Entry> const Entry* at(const Entry* const* array, int place)
{
    return array == NULL ? NULL : array[place];
}

/* Of a piece in an object of several: 0 stands for the one mesh without levels. */
inline int level_count(const int* counts, int piece)
{
    return counts == NULL || counts[piece] == 0 ? 1 : counts[piece];
}

class PartBuilder {
public:
    PartBuilder(const Objects& objects, bool is_fixed, Convexity convexity, const Adder& adder)
        : objects_(objects), object_(objects.next_id()), is_fixed_(is_fixed), convexity_(convexity), adder_(adder)
    {
    }

    /* One piece, from levels or as a copy. */
    bool build(int index, const LevelArrays& arrays, const CopySource& source, const PartSettings& settings, Part& part) const
    {
        const std::string about = about_piece(adder_.method, object_, index);
        if (source.object >= 0) {
            return from_copy(index, source, arrays.transform(0), settings, part);
        }
        if (arrays.count < 1) {
            report(about + "Invalid number of levels given (must be positive): " + text(arrays.count));
            return false;
        }
        if (arrays.count > MOST_LEVELS) {
            report(about + "Invalid number of levels given (must be less than or equal to 32): " + text(arrays.count));
            return false;
        }
        std::vector<Mesh> levels(static_cast<std::size_t>(arrays.count));
        for (int level = 0; level < arrays.count; ++level) {
            if (!arrays.read(level, about, levels[static_cast<std::size_t>(level)])) {
                if (arrays.filenames != NULL) {
                    report(about + "File read failed");
                } else if (adder_.verbosity == SAYS_CREATION_FAILED) {
                    report(about + "Mesh creation failed");
                }
                return false;
            }
        }
        return from_levels(index, levels, settings, part);
    }

    /* From the levels of one piece, the body first, after the input transform. */
    bool from_levels(int index, std::vector<Mesh>& levels, const PartSettings& settings, Part& part) const
    {
        if (settings.box_setting == BOX_SETTING_COPY) {
            report(about_piece(adder_.method, object_, index) + "Cannot set box type to COPY when copy is not done");
            return false;
        }
        part.pieces.resize(1);
        if (!part.pieces[0].make(levels, convexity_, settings.levels)) {
            std::vector<Mesh> pieces;
            if (adder_.decomposes && pieces_of_surface(levels[0], pieces)) {
                return from_decomposition(pieces, CONVEXITY_OF_PATCH, settings, part);
            }
            say_why(index, levels[0]);
            return false;
        }
        finish(settings, box_of_new(settings.box_setting), part);
        return true;
    }

    /* From the pieces of a decomposition, after the input transform. */
    bool from_decomposition(std::vector<Mesh>& pieces, Convexity convexity, const PartSettings& settings, Part& part) const
    {
        part.pieces.resize(pieces.size());
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            std::vector<Mesh> levels(1);
            std::swap(levels[0], pieces[i]);
            if (!part.pieces[i].make(levels, convexity, settings.levels)) {
                say_why(static_cast<int>(i), levels[0]);
                return false;
            }
        }
        finish(settings, box_of_new(settings.box_setting), part);
        return true;
    }

    /* Shares the geometry of a part; where the input transform is not the identity, it makes a new one from it. */
    bool from_copy(int index, const CopySource& source, const Transform& transform, const PartSettings& settings, Part& part) const
    {
        if (!objects_.has(source.object)) {
            report(about_piece(adder_.method, object_, index) + "Invalid object id given to copy a piece: " + text(source.object));
            return false;
        }
        const Object& object = objects_[source.object];
        if (static_cast<std::size_t>(source.piece) >= object.parts.size()) {
            report(about_piece(adder_.method, object_, index) + "Invalid piece id given to copy a piece: " + text(source.piece));
            return false;
        }
        const Part& original = object.parts[static_cast<std::size_t>(source.piece)];
        part.pieces = original.pieces;
        for (std::size_t i = 0; i < part.pieces.size() && !transform.is_identity(); ++i) {
            std::vector<Mesh> levels = original.pieces[i]->levels;
            for (std::size_t level = 0; level < levels.size(); ++level) {
                levels[level].transform(transform);
            }
            const Convexity convexity = original.pieces[i]->is_patch ? CONVEXITY_OF_PATCH : CONVEXITY_BY_HULL;
            if (!part.pieces[i].make(levels, convexity, settings.levels)) {
                say_why(index, levels[0]);
                return false;
            }
        }
        BoxKind box = settings.box_setting == BOX_SETTING_CUBE ? BOX_CUBE : BOX_TIGHT;
        if (settings.box_setting == BOX_SETTING_COPY || (settings.box_setting == BOX_SETTING_DEFAULT && !object.is_fixed)) {
            box = original.box;
        } else if (settings.box_setting == BOX_SETTING_DEFAULT) {
            box = BOX_CUBE;
        }
        finish(settings, is_fixed_ ? BOX_TIGHT : box, part);
        return true;
    }

private:
    const Objects& objects_;
    int object_;
    bool is_fixed_;
    Convexity convexity_;
    const Adder adder_;

    /* A body that SWIFT is to choose a box for gets the tight one. */
    BoxKind box_of_new(int setting) const
    {
        return !is_fixed_ && (setting == BOX_SETTING_DEFAULT || setting == BOX_SETTING_CUBE) ? BOX_CUBE : BOX_TIGHT;
    }

    void finish(const PartSettings& settings, BoxKind box, Part& part) const
    {
        part.box = box;
        part.box_centre = adder_.box_centre;
        part.enlargement_relative = settings.enlargement_relative;
        part.enlargement_absolute = settings.enlargement_absolute;
        part.measure();
    }

    /* Right after the failure. */
    void say_why(int index, const Mesh& mesh) const
    {
        std::string why = swiftprox_library_last_error_message();
        const std::string fault = surface_fault(mesh);
        if (!fault.empty()) {
            report(fault);
        }
        /* What a program in C would set. */
        const std::size_t advice = why.find("; the input policy ");
        if (advice != std::string::npos) {
            why = why.substr(0, advice) + "; " + adder_.cure;
        }
        report(about_piece(adder_.method, object_, index) + why);
        if (adder_.verbosity == SAYS_CREATION_FAILED) {
            report(about_piece(adder_.method, object_, index) + "Mesh creation failed");
        }
    }
};

} // namespace swift_legacy

#endif
