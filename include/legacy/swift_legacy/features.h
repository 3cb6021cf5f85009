/* Features as they were reported of old: six combinations of kinds, ids in a packed stream. */
#ifndef SWIFT_LEGACY_FEATURES_H
#define SWIFT_LEGACY_FEATURES_H

#include "defaults.h"
#include "geometry.h"

namespace swift_legacy {

/* What the ids of an intersecting pair take: what its features need, as in SWIFT 1.x, or four places, as in SWIFT++. */
enum IntersectingFeatures { INTERSECTING_TAKE_NEEDED, INTERSECTING_TAKE_FOUR };

/* The nearest feature of one object. */
class FeatureSide {
public:
    FeatureSide(const Geometry& geometry, const swiftprox_feature& feature, const double* point)
        : geometry_(&geometry), point_(point), type_(SWIFT_VERTEX)
    {
        ids_[0] = feature.ids[0];
        ids_[1] = feature.ids[1];
        if (feature.kind == SWIFTPROX_FEATURE_KIND_EDGE) {
            type_ = SWIFT_EDGE;
        } else if (feature.kind == SWIFTPROX_FEATURE_KIND_FACE) {
            type_ = SWIFT_FACE;
        }
    }

    int type() const
    {
        return type_;
    }

    /* The corner nearest to the point takes the feature's place. */
    void become_vertex()
    {
        if (type_ == SWIFT_EDGE) {
            const bool is_second = geometry_->square_distance(ids_[1], point_) < geometry_->square_distance(ids_[0], point_);
            ids_[0] = ids_[is_second ? 1 : 0];
        } else if (type_ == SWIFT_FACE) {
            ids_[0] = geometry_->nearest_corner(ids_[0], point_);
        }
        type_ = SWIFT_VERTEX;
    }

    void append_ids(std::vector<int>& out) const
    {
        if (type_ == SWIFT_FACE) {
            out.push_back(geometry_->face_label(ids_[0]));
        } else if (type_ == SWIFT_VERTEX) {
            out.push_back(geometry_->vertex_label(ids_[0]));
        } else {
#if defined(SWIFT_ONLY_TRIS) && defined(SWIFT_REPORT_EDGE_IDS)
            out.push_back(geometry_->edge_id(ids_[0], ids_[1]));
#else
            out.push_back(geometry_->vertex_label(ids_[0]));
            out.push_back(geometry_->vertex_label(ids_[1]));
#endif
        }
    }

private:
    const Geometry* geometry_;
    const double* point_;
    int type_;
    uint32_t ids_[2];
};

struct FeaturePair {
    FeatureSide sides[2];

    /*
     * To a combination that old programs know: beside a face there is a vertex. swiftprox answers others where bodies intersect,
     * and where its exact arithmetic decides.
     */
    void reduce()
    {
        if (sides[1].type() == SWIFT_FACE) {
            sides[0].become_vertex();
        } else if (sides[0].type() == SWIFT_FACE) {
            sides[1].become_vertex();
        }
    }
};

} // namespace swift_legacy

#endif
