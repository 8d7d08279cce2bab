// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/sam_part.h"

#include <map>

#include "engine/edit/handler_colors.h"
#include "engine/segment/random_walk.h"

namespace cei3d {
namespace {

constexpr float kSure = 0.9f;  // scores from which (and 1 minus it, below which) the votes are kept

// Prior of points without votes: they get the score of neighbors of similar color, or are outside without
// such neighbors.
constexpr float kUntold = 0.49f;

// Runs the network on images of the views, each made once.
class EncodedViews : public ViewSegmenter {
 public:
  EncodedViews(const Device& device, const Scene& scene, const SamPartRequest& request, SamMemory& sam)
      : device_(device), scene_(scene), request_(request), sam_(sam) {}

  Image mask(int view, std::span<const Vec2f> positive, std::span<const Vec2f> negative) override {
    std::shared_ptr<const SamImage>& encoded = encoded_[view];
    if (!encoded) encoded = sam_.encoded(image(view));
    return sam_.network().mask(*encoded, positive, negative);
  }

 private:
  Image image(int view) const {
    return request_.image ? request_.image(view)
                          : albedo_image(device_, scene_, request_.views.cameras[size_t(view)]);
  }

  const Device& device_;
  const Scene& scene_;
  const SamPartRequest& request_;
  SamMemory& sam_;
  std::map<int, std::shared_ptr<const SamImage>> encoded_;  // by view
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
