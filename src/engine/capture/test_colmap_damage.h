// SPDX-License-Identifier: Apache-2.0
// For tests: a good capture as a COLMAP model with a lens and tracks, and what goes wrong with such models.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/math/lens.h"
#include "engine/capture/normalize.h"
#include "engine/capture/test_damage.h"
#include "engine/capture/test_formats.h"

namespace cei3d {

// What a lens makes of a pinhole image; samples lie a quarter of a pixel apart.
inline Image through_lens(const Image& image, const PhotoCamera& photo) {
  constexpr int kFine = 4;
  const Image fine = scaled_to(image, kFine * image.width, kFine * image.height);
  Image out(image.width, image.height, image.channels);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto p = pinhole_from_photo(photo, photo.camera(), {x + 0.5, y + 0.5});
      if (p && p->x >= 0 && p->y >= 0 && p->x < image.width && p->y < image.height)
        std::copy_n(fine.at(int(kFine * p->x), int(kFine * p->y)), image.channels, out.at(x, y));
    }
  return out;
}

class ColmapCopy {
 public:
  // Writes the training views of a good capture of RGBA images, seen through a lens. The points lie on a ball
  // around the object, where its tracks could be as well as anywhere.
  ColmapCopy(const Capture& good, const Normalization& n, const std::filesystem::path& folder)
      : folder_(folder), ball_{n.center, kObjectRadius / n.scale} {
    model_.model = 4, model_.model_name = "OPENCV";
    model_.lens = {-0.1, 0.03, 0.012, -0.004};
    model_.distortion = {LensKind::perspective, {-0.1, 0.03, 0, 0}, {}, 0.012, -0.004};
    model_.points = points_on_ball(ball_, 80);
    for (const View& v : good.views) {
      if (v.split != Split::train) continue;
      views_.push_back({std::to_string(1000 + views_.size()).replace(0, 1, "r_"), v.camera});
      write_png(folder / "images" / (views_.back().stem + ".png"),
                through_lens(read_image(v.image_path), PhotoCamera(v.camera, model_.distortion)));
    }
    write_model("0", views_);
  }
  std::filesystem::path model(const char* number) const { return folder_ / "sparse" / number; }
  void write_model(const char* number, const std::vector<TestView>& views) const {
    write_colmap_txt(model(number), ball_, views, model_);
  }
  // Parameters: fx, fy, cx, cy, k1, k2, p1, p2.
  void change(const std::function<void(std::vector<double>&)>& change) const {
    change_colmap_cameras(model("0"), 8, change);
  }
  const std::vector<TestView>& views() const { return views_; }

 private:
  std::filesystem::path folder_;
  TestBall ball_;
  TestColmap model_;
  std::vector<TestView> views_;
};

struct ColmapDamage {
  const char* name;
  std::function<void(const ColmapCopy&)> make;
  std::string says;
};

inline std::vector<ColmapDamage> usual_colmap_damages() {
  using P = std::vector<double>;
  return {
      {"p1 and p2 exchanged", [](const ColmapCopy& c) { c.change([](P& p) { std::swap(p[6], p[7]); }); },
       "p1 and p2 are exchanged"},
      {"half a pixel", [](const ColmapCopy& c) { c.change([](P& p) { p[2] += 0.5, p[3] += 0.5; }); },
       "half a pixel"},
      {"half a pixel less", [](const ColmapCopy& c) { c.change([](P& p) { p[2] -= 0.5, p[3] -= 0.5; }); },
       "half a pixel"},
      {"lens of the other direction",
       [](const ColmapCopy& c) { c.change([](P& p) { p[4] = -p[4], p[5] = -p[5]; }); }, "other sign"},
      {"K of another size",
       [](const ColmapCopy& c) {
         c.change([](P& p) {
           for (size_t i = 0; i < 4; ++i) p[i] *= 2;
         });
       },
       "K is multiplied by|principal points"},
      {"two models",
       [](const ColmapCopy& c) {
         c.write_model("1", {c.views().begin(), c.views().begin() + 4});
       },
       "2 models"},
  };
}

}  // namespace cei3d
