// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/sam_part.h"

#include <algorithm>
#include <map>

#include "core/math/pixel_box.h"
#include "engine/edit/handler_colors.h"
#include "engine/segment/random_walk.h"

namespace cei3d {
namespace {

constexpr float kSure = 0.9f;  // scores from which (and 1 minus it, below which) the votes are kept

// Prior of points without votes: they get the score of neighbors of similar color, or are outside without
// such neighbors.
constexpr float kUntold = 0.49f;

// Maximum size of the longer side of the images that the network sees, in pixels, whatever the size of the
// photographs: as many as its masks have. Sharper images cost more, and masks follow them no better.
constexpr double kMaxImage = 256;
constexpr double kMargin = 0.1;  // around the object, as a share of its longer side; sam_frame() keeps less

// Where the camera shows the object; all of its image, if nowhere.
PixelBox object_box(const Camera& camera, const HandlerPoints& handlers) {
  std::vector<Vec2f> pixels;
  for (const Vec3f p : handlers.positions) {
    const Vec3d at = camera.project(to_double(p));
    if (at.z > 0 && at.x >= 0 && at.y >= 0 && at.x < camera.width && at.y < camera.height)
      pixels.push_back({float(at.x), float(at.y)});
  }
  const PixelBox all{0, 0, camera.width, camera.height};
  return pixels.empty() ? all : box_around(pixels, kMargin, all);
}

// Runs the network on images of the views, each made once.
class EncodedViews : public ViewSegmenter {
 public:
  EncodedViews(const Device& device, const Scene& scene, const SamPartRequest& request, SamMemory& sam)
      : device_(device), scene_(scene), request_(request), sam_(sam) {}

  Image mask(int view, std::span<const Vec2f> positive, std::span<const Vec2f> negative) override {
    auto at = encoded_.find(view);
    if (at == encoded_.end()) at = encoded_.emplace(view, encoded(view)).first;
    return sam_.network().mask(at->second, positive, negative);
  }

 private:
  SamImage encoded(int view) const {
    if (request_.image) return *sam_.encoded(request_.image(view));
    const Camera& camera = request_.views.cameras[size_t(view)];
    const PixelBox box = object_box(camera, *scene_.handlers);
    const double scale = std::min(1.0, kMaxImage / std::max(box.width, box.height));
    const Camera close = crop_camera(camera, box, scale);
    return of_whole(*sam_.encoded(albedo_image(device_, scene_, close)), camera.width, camera.height, box,
                    scale);
  }

  const Device& device_;
  const Scene& scene_;
  const SamPartRequest& request_;
  SamMemory& sam_;
  std::map<int, SamImage> encoded_;  // by view
};

}  // namespace

PropagateResult sam_part(const Device& device, const Scene& scene, const SamPartRequest& request,
                         SamMemory& sam, Progress& progress) {
  EncodedViews views(device, scene, request, sam);
  PropagateResult result = propagate(*scene.handlers, *scene.surface, request.views, views, progress);
  std::vector<Seed> seeds;
  for (float& score : result.scores) {
    seeds.push_back(score > kSure ? Seed::positive : score < 1 - kSure ? Seed::negative : Seed::none);
    if (score == 0.5f) score = kUntold;
  }
  for (size_t i = 0; i < request.certain.size(); ++i)
    if (request.certain[i] != Seed::none) seeds[i] = request.certain[i];
  const PointGraph graph = point_graph(*scene.handlers, handler_colors(device, scene), request.graph);
  result.scores = random_walk(graph, seeds, result.scores);
  return result;
}

}  // namespace cei3d
