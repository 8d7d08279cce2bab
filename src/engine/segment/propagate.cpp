// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/propagate.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/math/activation.h"
#include "engine/segment/seen_points.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {
namespace {

constexpr float kMinFacing = 0.2f;       // minimum cosine to the camera of points that get votes
constexpr float kPromptFacing = 0.4f;    // minimum cosine of points that become prompts
constexpr float kBelieved = 0.7f;        // score from which a point counts as inside; 1 - kBelieved: outside
constexpr float kPrior = 0.1f;           // weight of the prior 1/2 relative to one frontal vote
constexpr float kFirstWeight = 2;        // weight of the clicked view, which the user has seen
constexpr float kMinAgreement = 0.6f;    // minimum intersection over union of a mask with the believed points
constexpr float kGoodAgreement = 0.92f;  // agreement from which a mask needs no correction
constexpr int kCorrections = 4;          // maximum number of extra prompts, added one at a time
constexpr size_t kPrompts = 5;           // prompts of each kind, besides those of the user
constexpr size_t kSamples = 500;         // number of points of the part used to choose views
constexpr float kEnough = 0.5f;          // votes, in frontal votes, that halve the need for more
constexpr float kSurroundings = 0.5f;    // distance around the part, in its extents, where votes are wanted
constexpr float kMinGain = 0.03f;        // minimum mean gain per point for which a view is segmented
constexpr float kMinSeen = 0.07f;        // minimum share of the part that a view must show

// Score of each point from the masks so far.
class Votes {
 public:
  Votes(size_t n, MaskCombination combination) : combination_(combination), sum_(n, 0.0f), weight_(n, 0.0f) {}
  void add(uint32_t point, float probability, float weight) {
    sum_[point] +=
        weight * (combination_ == MaskCombination::votes ? probability : float(probability > 0.5f));
    weight_[point] += weight;
  }
  float score(size_t i) const {
    if (combination_ == MaskCombination::any) return sum_[i] > 0 ? 1 : weight_[i] > 0 ? 0 : 0.5f;
    return (sum_[i] + 0.5f * kPrior) / (weight_[i] + kPrior);
  }
  // Information that one more vote would add, [0, 1]: much where there are few votes, or where they disagree.
  // Where any mask counts votes cannot disagree.
  float need(size_t i) const {
    const float p = combination_ == MaskCombination::votes ? score(i) : 0.5f;
    return 4 * p * (1 - p) / (1 + weight_[i] / kEnough);
  }
  bool in(size_t i) const { return score(i) >= kBelieved; }
  bool out(size_t i) const { return score(i) <= 1 - kBelieved; }
  size_t size() const { return sum_.size(); }

 private:
  MaskCombination combination_;
  std::vector<float> sum_, weight_;
};

// Intersection over union of the mask and the believed points, over points with a belief, and the pixels
// where they differ.
struct Comparison {
  float agreement = 0;
  std::vector<Vec2f> missing, surplus, right_in, right_out;
};

Comparison compare(const std::vector<SeenPoint>& seen, const Votes& votes, const Image& mask) {
  Comparison c;
  float both = 0, either = 0;
  for (const SeenPoint& s : seen) {
    const bool in = votes.in(s.point), masked = sample(mask, s.pixel) > 0;
    if (!in && !votes.out(s.point)) continue;
    if (in && masked) both += s.facing;
    if (in || masked) either += s.facing;
    if (s.facing < kPromptFacing) continue;
    (in ? masked ? c.right_in : c.missing : masked ? c.surplus : c.right_out).push_back(s.pixel);
  }
  c.agreement = either > 0 ? both / either : 0;
  return c;
}

std::vector<Vec3f> every(const std::vector<size_t>& ids, size_t max_count,
                         const std::vector<Vec3f>& positions) {
  const size_t step = std::max<size_t>(ids.size() / max_count, 1);
  std::vector<Vec3f> kept;
  for (size_t k = 0; k < ids.size(); k += step) kept.push_back(positions[ids[k]]);
  return kept;
}

// Root mean square distance from the mean.
float extent(const std::vector<Vec3f>& points) {
  const auto n = float(points.size());
  Vec3f mean{0, 0, 0};
  for (Vec3f p : points) mean += p / n;
  float squares = 0;
  for (Vec3f p : points) squares += dot(p - mean, p - mean) / n;
  return std::sqrt(squares);
}

class Propagation {
 public:
  Propagation(const HandlerPoints& handlers, const Surface& surface, const PropagateRequest& request,
              ViewSegmenter& segmenter)
      : handlers_(handlers),
        surface_(surface),
        request_(request),
        segmenter_(segmenter),
        votes_(handlers.positions.size(), request.plan.combination),
        tolerance_(std::max(2 * handlers.spacing, 0.01f)) {
    find_clicks(request.clicks.positive, positive_);
    find_clicks(request.clicks.negative, negative_);
  }

  void first_view();
  void next_view(int view);
  // The next view by the plan's order; -1: none is left, or none is useful.
  int choose_view() const {
    return request_.plan.order == ViewOrder::adjacent ? adjacent_view() : informative_view();
  }
  PropagateResult result() const;
  size_t segmented() const { return report_.views.size() + report_.refused.size(); }

 private:
  struct Places {
    std::vector<Vec3f> positions, normals;
  };
  void find_clicks(const std::vector<Vec2f>& pixels, Places& places) const;
  void vote(const std::vector<SeenPoint>& seen, const Image& mask, float weight);
  std::vector<SeenPoint> seen_by(int view, const std::vector<Vec3f>& positions,
                                 const std::vector<Vec3f>& normals, float facing) const {
    return seen_points(surface_, request_.cameras[view], positions, normals, facing, tolerance_);
  }
  Image first_mask() const;
  int adjacent_view() const;
  int informative_view() const;
  Prompts prompts_for(int view, const std::vector<SeenPoint>& seen) const;
  Places wanted(std::vector<float>& need, std::vector<uint8_t>& in) const;
  bool used(int view) const;

  const HandlerPoints& handlers_;
  const Surface& surface_;
  const PropagateRequest& request_;
  ViewSegmenter& segmenter_;
  Votes votes_;
  float tolerance_;
  Places positive_, negative_;  // surface points that the user clicked
  int last_ = 0;                // the view segmented last
  PropagateReport report_;
};

void Propagation::find_clicks(const std::vector<Vec2f>& pixels, Places& places) const {
  std::vector<Vec3f> origins, directions;
  for (Vec2f p : pixels) {
    const Ray ray = request_.cameras[request_.first].ray(p.x, p.y);
    origins.push_back(ray.origin);
    directions.push_back(ray.direction);
  }
  std::vector<Surface::RayHit> hits(pixels.size());
  surface_.intersect(origins, directions, 0, hits);
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].t < 0) continue;
    const auto& corners = surface_.mesh().triangles[hits[i].triangle];
    places.positions.push_back(origins[i] + directions[i] * hits[i].t);
    places.normals.push_back(normalize(at_corners(surface_.mesh().normals, corners, hits[i].b1, hits[i].b2)));
  }
}

void Propagation::vote(const std::vector<SeenPoint>& seen, const Image& mask, float weight) {
  for (const SeenPoint& s : seen)
    votes_.add(s.point, Sigmoid::eval(sample(mask, s.pixel), 1).value, weight * s.facing);
}

// Log-odds: the user's own mask, else that of the clicks.
Image Propagation::first_mask() const {
  constexpr float kSureOdds = 4;
  const Prompts& clicks = request_.clicks;
  if (request_.mask.empty()) return segmenter_.mask(request_.first, clicks.positive, clicks.negative);
  Image odds = request_.mask;
  for (float& m : odds.data) m = m >= 0.5f ? kSureOdds : -kSureOdds;
  return odds;
}

void Propagation::first_view() {
  const int view = request_.first;
  const std::vector<SeenPoint> seen = seen_by(view, handlers_.positions, handlers_.normals, kMinFacing);
  vote(seen, first_mask(), kFirstWeight);
  last_ = view;
  report_.views.push_back(view);
  const bool found =
      std::any_of(seen.begin(), seen.end(), [&](const SeenPoint& s) { return votes_.in(s.point); });
  if (!found)
    fail(
        "The network finds no part at these clicks. Click nearer to the middle of the part, or let "
        "it grow there (segmenter grow).");
}

Prompts Propagation::prompts_for(int view, const std::vector<SeenPoint>& seen) const {
  Prompts prompts;
  for (const SeenPoint& s : seen_by(view, positive_.positions, positive_.normals, kPromptFacing))
    prompts.positive.push_back(s.pixel);
  for (const SeenPoint& s : seen_by(view, negative_.positions, negative_.normals, kPromptFacing))
    prompts.negative.push_back(s.pixel);
  BelievedPixels believed;
  for (const SeenPoint& s : seen) {
    if (s.facing < kPromptFacing)
      believed.unknown.push_back(s.pixel);
    else
      (votes_.in(s.point)    ? believed.in
       : votes_.out(s.point) ? believed.out
                             : believed.unknown)
          .push_back(s.pixel);
  }
  add_prompts(believed, kPrompts, prompts);
  return prompts;
}

// Adds a prompt where the mask differs most from the believed points, as a user would, and segments again.
// When any mask counts there is no such check.
void Propagation::next_view(int view) {
  const std::vector<SeenPoint> seen = seen_by(view, handlers_.positions, handlers_.normals, kMinFacing);
  Prompts prompts = prompts_for(view, seen);
  last_ = view;
  if (request_.plan.combination == MaskCombination::any && !prompts.positive.empty()) {
    vote(seen, segmenter_.mask(view, prompts.positive, prompts.negative), 1);
    report_.views.push_back(view);
    return;
  }
  Image best;
  float agreement = 0;
  for (int round = 0; round <= kCorrections && !prompts.positive.empty(); ++round) {
    Image mask = segmenter_.mask(view, prompts.positive, prompts.negative);
    const Comparison c = compare(seen, votes_, mask);
    if (c.agreement > agreement) {
      agreement = c.agreement;
      best = std::move(mask);
    }
    if (c.agreement >= kGoodAgreement || (c.missing.empty() && c.surplus.empty())) break;
    if (c.missing.size() >= c.surplus.size())
      prompts.positive.push_back(deepest(c.missing, c.right_in));
    else
      prompts.negative.push_back(deepest(c.surplus, c.right_out));
  }
  if (agreement < kMinAgreement) {
    report_.refused.push_back(view);
    return;
  }
  vote(seen, best, 1);
  report_.views.push_back(view);
}

// Points for which votes are wanted: the part, and its surroundings up to half of its extent.
Propagation::Places Propagation::wanted(std::vector<float>& need, std::vector<uint8_t>& in) const {
  std::vector<size_t> part;
  for (size_t i = 0; i < votes_.size(); ++i)
    if (votes_.in(i)) part.push_back(i);
  const std::vector<Vec3f> sample = every(part, kSamples, handlers_.positions);
  const float reach = kSurroundings * extent(sample);
  const PointIndex index(sample, reach);
  std::vector<size_t> near;
  for (size_t i = 0; i < votes_.size(); ++i)
    if (votes_.in(i) || index.any_within(handlers_.positions[i], reach, [](size_t) { return true; }))
      near.push_back(i);
  Places places;
  const size_t step = std::max<size_t>(near.size() / kSamples, 1);
  for (size_t k = 0; k < near.size(); k += step) {
    places.positions.push_back(handlers_.positions[near[k]]);
    places.normals.push_back(handlers_.normals[near[k]]);
    need.push_back(votes_.need(near[k]));
    in.push_back(votes_.in(near[k]));
  }
  return places;
}

bool Propagation::used(int view) const {
  const auto has = [&](const std::vector<int>& v) { return std::find(v.begin(), v.end(), view) != v.end(); };
  return has(report_.views) || has(report_.refused);
}

// By the angle between the directions from the object's middle; of equals, the first.
int Propagation::adjacent_view() const {
  const auto direction = [&](int view) { return normalize(request_.cameras[size_t(view)].center); };
  double best = -2;
  int chosen = -1;
  for (int view = 0; view < int(request_.cameras.size()); ++view) {
    if (used(view)) continue;
    const double cosine = dot(direction(view), direction(last_));
    if (cosine > best) best = cosine, chosen = view;
  }
  return chosen;
}

// The view with the largest product of new information and known share of the part. Without the second factor
// the first step would go to a view that shows hardly any believed point, and its mask would contradict those
// few.
int Propagation::informative_view() const {
  std::vector<float> need;
  std::vector<uint8_t> in;
  const Places places = wanted(need, in);
  const auto part = float(std::count(in.begin(), in.end(), 1));
  float best = 0;
  int chosen = -1;
  for (int view = 0; view < int(request_.cameras.size()); ++view) {
    if (used(view)) continue;
    float known = 0, gain = 0;
    for (const SeenPoint& s : seen_by(view, places.positions, places.normals, kMinFacing)) {
      if (in[s.point]) known += s.facing;
      gain += s.facing * need[s.point];
    }
    if (known < kMinSeen * part || gain < kMinGain * float(need.size())) continue;
    if (gain * known <= best) continue;
    best = gain * known;
    chosen = view;
  }
  return chosen;
}

PropagateResult Propagation::result() const {
  PropagateResult r;
  r.report = report_;
  for (size_t i = 0; i < votes_.size(); ++i) r.scores.push_back(votes_.score(i));
  return r;
}

}  // namespace

PropagateResult propagate(const HandlerPoints& handlers, const Surface& surface,
                          const PropagateRequest& request, ViewSegmenter& segmenter, Progress& progress) {
  Propagation p(handlers, surface, request, segmenter);
  p.first_view();
  const int views = std::min(request.plan.max_views, int(request.cameras.size()));
  while (int(p.segmented()) < views) {
    check_cancelled(progress, "Interrupted; nothing was changed.");
    ProgressReport report;
    report.stage = "views";
    report.fraction = double(p.segmented()) / views;
    progress.report(report);
    const int view = p.choose_view();
    if (view < 0) break;
    p.next_view(view);
  }
  return p.result();
}

}  // namespace cei3d
