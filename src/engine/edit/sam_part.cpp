// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/sam_part.h"

#include <map>

#include "engine/edit/handler_colors.h"
#include "engine/segment/random_walk.h"
#include "engine/segment/sam.h"

namespace cei3d {
namespace {

constexpr float kSure = 0.9f;  // scores from which (and 1 minus it, below which) the votes are kept

// Prior of points without votes: they get the score of neighbors of similar color, or are outside without
// such neighbors.
constexpr float kUntold = 0.49f;

// Runs the network on albedo images, each encoded once.
class AlbedoViews : public ViewSegmenter {
 public:
  AlbedoViews(const Device& device, const Scene& scene, const SamPartRequest& request)
      : device_(device),
        scene_(scene),
        cameras_(request.views.cameras),
        sam_(request.networks, request.threads) {}

  Image mask(int view, std::span<const Vec2f> positive, std::span<const Vec2f> negative) override {
    auto it = pictures_.find(view);
    if (it == pictures_.end())
      it = pictures_.emplace(view, sam_.encode(albedo_image(device_, scene_, cameras_[view]))).first;
    return sam_.mask(it->second, positive, negative);
  }

 private:
  const Device& device_;
  const Scene& scene_;
  const std::vector<Camera>& cameras_;
  Sam sam_;
  std::map<int, SamImage> pictures_;
};

}  // namespace

PropagateResult sam_part(const Device& device, const Scene& scene, const SamPartRequest& request,
                         Progress& progress) {
  AlbedoViews views(device, scene, request);
  PropagateResult result = propagate(*scene.handlers, *scene.surface, request.views, views, progress);
  std::vector<Seed> seeds;
  for (float& score : result.scores) {
    seeds.push_back(score > kSure ? Seed::positive : score < 1 - kSure ? Seed::negative : Seed::none);
    if (score == 0.5f) score = kUntold;
  }
  const PointGraph graph = point_graph(*scene.handlers, handler_colors(device, scene));
  result.scores = random_walk(graph, seeds, result.scores);
  return result;
}

}  // namespace cei3d
