/* The objects of a scene: dense ids that are used again, the last deleted one first, order of creation, boxes. */
#ifndef SWIFT_LEGACY_OBJECTS_H
#define SWIFT_LEGACY_OBJECTS_H

#include <algorithm>

#include "geometry.h"

namespace swift_legacy {

/* How a part's box is made: a cube that holds the part however it turns, or the tight box. */
enum BoxKind { BOX_CUBE, BOX_TIGHT };

/* About what cubes lie: SWIFT 1.x measures them from the centroid, SWIFT++ from the origin of the local frame. */
enum BoxCentre { BOX_ABOUT_CENTROID, BOX_ABOUT_ORIGIN };

/* A box along the axes of the world. */
struct Box {
    double lower[3];
    double upper[3];

    void begin_at(const double* point)
    {
        std::copy(point, point + 3, lower);
        std::copy(point, point + 3, upper);
    }

    void take_in(const double* point)
    {
        for (int axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], point[axis]);
            upper[axis] = std::max(upper[axis], point[axis]);
        }
    }

    void grow(double margin)
    {
        for (int axis = 0; axis < 3; ++axis) {
            lower[axis] -= margin;
            upper[axis] += margin;
        }
    }
};

inline bool overlap(const Box& a, const Box& b)
{
    bool are_apart = false;
    for (int axis = 0; axis < 3; ++axis) {
        are_apart = are_apart || a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis];
    }
    return !are_apart;
}

/*
 * What queries list: a convex piece, or several that count as one (of a decomposition). With the broad phase on, its enlarged box
 * says whether a query without a tolerance lists it.
 */
struct Part {
    std::vector<Piece> pieces;
    BoxKind box;
    BoxCentre box_centre;
    double enlargement_relative;
    double enlargement_absolute;
    double centroid[3];
    double radius; /* about what the cube lies about */
    Box world_box; /* where Object::has_boxes */

    Part() : box(BOX_CUBE), box_centre(BOX_ABOUT_CENTROID), enlargement_relative(0), enlargement_absolute(0), radius(0), world_box()
    {
        std::fill(centroid, centroid + 3, 0.0);
    }

    double enlargement() const
    {
        return enlargement_relative * radius + enlargement_absolute;
    }

    /* Once the pieces stand and it is known about what the cube lies. */
    void measure()
    {
        SurfaceCentroid sum;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            sum.add(pieces[i]->body());
        }
        for (int axis = 0; axis < 3; ++axis) {
            centroid[axis] = sum[axis];
        }
        const double origin[3] = {0, 0, 0};
        const double* centre = box_centre == BOX_ABOUT_ORIGIN ? origin : centroid;
        radius = 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            for (std::size_t v = 0; v < pieces[i]->body().vertex_count(); ++v) {
                radius = std::max(radius, std::sqrt(pieces[i]->square_distance(static_cast<uint32_t>(v), centre)));
            }
        }
    }

    /* The cube that is measured from the origin reaches as far about the centroid as well: it holds those of all versions. */
    void place_box(const double* pose)
    {
        double point[3];
        place(pose, centroid, point);
        world_box.begin_at(point);
        if (box == BOX_CUBE) {
            if (box_centre == BOX_ABOUT_ORIGIN) {
                const double world_origin[3] = {pose[3], pose[7], pose[11]};
                world_box.take_in(world_origin);
            }
            world_box.grow(radius + enlargement());
            return;
        }
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const std::vector<double>& vertices = pieces[i]->body().vertices;
            for (std::size_t v = 0; v < vertices.size(); v += 3) {
                place(pose, &vertices[v], point);
                world_box.take_in(point);
            }
        }
        world_box.grow(enlargement());
    }

private:
    static void place(const double* pose, const double* v, double* image)
    {
        for (int i = 0; i < 3; ++i) {
            image[i] = pose[4 * i] * v[0] + pose[4 * i + 1] * v[1] + pose[4 * i + 2] * v[2] + pose[4 * i + 3];
        }
    }
};

/* Several parts are a piece each; one part of several pieces is a compound in the scene. */
struct Object {
    swiftprox_object_id native;
    bool is_live;
    bool is_fixed;
    std::vector<Part> parts;
    bool has_boxes;

    Object() : native(), is_live(false), is_fixed(false), has_boxes(false) {}

    /* The part, and the geometry, of a piece that the scene names. */
    int part_of(uint32_t piece) const
    {
        return parts.size() == 1 ? 0 : static_cast<int>(piece);
    }

    const Geometry& geometry_of(uint32_t piece) const
    {
        return parts.size() == 1 ? *parts[0].pieces[piece] : *parts[piece].pieces[0];
    }

    void place_boxes(const double* pose)
    {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].place_box(pose);
        }
        has_boxes = true;
    }
};

class Objects {
public:
    Objects() : moving_(0), are_ranked_(true) {}

    bool has(int id) const
    {
        return id >= 0 && static_cast<std::size_t>(id) < objects_.size() && objects_[static_cast<std::size_t>(id)].is_live;
    }

    /* Null where there is none. */
    Object* find(int id)
    {
        Object* object = id >= 0 && static_cast<std::size_t>(id) < objects_.size() ? &objects_[static_cast<std::size_t>(id)] : NULL;
        return object != NULL && object->is_live ? object : NULL;
    }

    Object& operator[](int id)
    {
        return objects_[static_cast<std::size_t>(id)];
    }

    const Object& operator[](int id) const
    {
        return objects_[static_cast<std::size_t>(id)];
    }

    /* The id that the next object gets. */
    int next_id() const
    {
        return free_.empty() ? static_cast<int>(objects_.size()) : free_.back();
    }

    /* Room for one more, so that nothing can fail once the scene has it. */
    void reserve()
    {
        if (free_.empty()) {
            objects_.push_back(Object());
            free_.push_back(static_cast<int>(objects_.size()) - 1);
        }
        free_.reserve(objects_.size());
        created_.reserve(objects_.size());
    }

    /* As the next object; it takes the parts, which are empty then. */
    void add(swiftprox_object_id native, bool is_fixed, std::vector<Part>& parts)
    {
        const int id = next_id();
        Object& object = (*this)[id];
        object.native = native;
        object.is_live = true;
        object.is_fixed = is_fixed;
        object.has_boxes = false;
        object.parts.swap(parts);
        free_.pop_back();
        created_.push_back(id);
        moving_ += is_fixed ? 0 : 1;
        are_ranked_ = false;
    }

    void remove(int id)
    {
        Object& object = (*this)[id];
        moving_ -= object.is_fixed ? 0 : 1;
        object = Object();
        free_.push_back(id);
        created_.erase(std::find(created_.begin(), created_.end(), id));
        are_ranked_ = false;
    }

    /* The ids in order of creation. */
    const std::vector<int>& created() const
    {
        return created_;
    }

    /* Of those that are not fixed. */
    std::size_t moving_count() const
    {
        return moving_;
    }

    void forget_boxes()
    {
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            objects_[i].has_boxes = false;
        }
    }

    void rank()
    {
        if (!are_ranked_) {
            ranks_.resize(objects_.size());
            for (std::size_t i = 0; i < created_.size(); ++i) {
                ranks_[static_cast<std::size_t>(created_[i])] = static_cast<int>(i);
            }
            are_ranked_ = true;
        }
    }

    /* The place of an object in the order of creation, once they are ranked. */
    int rank_of(int id) const
    {
        return ranks_[static_cast<std::size_t>(id)];
    }

private:
    std::vector<Object> objects_; /* by id */
    std::vector<int> free_;       /* the next one last */
    std::vector<int> created_;
    std::vector<int> ranks_;
    std::size_t moving_;
    bool are_ranked_;
};

} // namespace swift_legacy

#endif
