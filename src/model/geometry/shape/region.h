// SPDX-License-Identifier: Apache-2.0
// A region of the surface by handler points that an edit labels: H+, the edited ones, and those beside them
// [paper sec. 4.2]. A point of the surface belongs to it if, of the labeled points within reach on the same
// side, the nearest is an edited one: docs/method.md#regions-and-routing.
//
// A region from a painted view also holds the painted mask with the camera and the depths of that view: a
// point belongs to it only if an edited point is within reach and that camera sees it inside the mask. The
// points select the surface, the mask is the border: as sharp as the scribble (alpha 0.5, interpolated
// between pixels), and hidden surfaces are not changed.
//
// A part of the object is a third kind: scored points (model/geometry/shape/scored_points.h).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/shelf.h"
#include "core/math/axis_box.h"
#include "core/math/vec.h"
#include "model/geometry/shape/point_index.h"
#include "model/geometry/shape/projector.h"
#include "model/geometry/shape/scored_points.h"

namespace cei3d {

class Region {
  struct Data;

 public:
  Region() = default;  // contains nothing
  struct Points {
    std::vector<Vec3f> positions;  // #N handler points, unit frame
    std::vector<Vec3f> normals;    // #N, unit
    std::vector<float> reach;      // #N, unit frame
    std::vector<uint8_t> edited;   // #N, 1: in H+, 0: beside the edit; empty: all are in H+
    bool is_edited(size_t i) const { return edited.empty() || edited[i]; }
    size_t edited_count() const;
  };
  // projector empty: the points alone decide. No points: the mask alone decides.
  explicit Region(Points points, Projector projector = {});
  explicit Region(ScoredPoints part);

  // normal: unit, outward.
  bool contains(Vec3f position, Vec3f normal) const;
  // Share of the edit at a point: 1 inside, 0 outside, the mask's alpha where the mask is soft.
  float weight(Vec3f position, Vec3f normal) const { return Weights(*this).at(position, normal); }
  // weight() of many points: the region's data are read at most once, and stay in memory while this lives.
  class Weights {
   public:
    explicit Weights(const Region& region) : region_(region) {}  // which must outlive this
    float at(Vec3f position, Vec3f normal);

   private:
    const Region& region_;
    std::optional<Shelved<Data>::Use> data_;
  };
  bool may_meet(const AxisBox& box) const { return !box_ || box_->meets(box); }  // false: no point is in both
  Points points() const { return data_->points; }
  Projector projector() const { return data_->projector; }
  ScoredPoints scored() const { return data_->scored; }  // empty: not a part

  // The same region, whose data may be dropped from memory; read() gives it again. Parts, of which there are
  // few, and regions without points stay in memory.
  Region shelved(const std::shared_ptr<Shelf>&, const std::string& name,
                 const std::function<Region()>& read) const;

  // Writes tensors "region/..." and the rest to the head. Errors of load(): missing tensors or keys, sizes
  // that disagree.
  void save(Tensors& tensors, Json& head) const;
  static Region load(const Tensors& tensors, const Json& head, const std::string& what = "A region");

 private:
  struct Data {
    Points points;
    Projector projector;
    ScoredPoints scored;
    PointIndex index;
    float max_reach = 0;

    bool contains(Vec3f position, Vec3f normal) const;
    size_t bytes() const;

   private:
    // Whether the nearest one, or any, of the labeled points within reach on the same side is edited.
    bool nearest_is_edited(Vec3f position, Vec3f normal) const;
    bool any_is_edited(Vec3f position, Vec3f normal) const;
  };
  static std::optional<AxisBox> box_of(const Data&);

  Shelved<Data> data_ = std::make_shared<const Data>();  // copies of a region share it
  std::optional<AxisBox> box_;                           // outside is nothing of the region; none: not known
};

}  // namespace cei3d
