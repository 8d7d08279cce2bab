// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

namespace cei3d {
namespace {

constexpr uint32_t kNone = ~0u;
constexpr float kCone = 0.4f;  // cosine between a face and the axis of its chart, at least
// kSmallCone: kCone of charts that are joined to another because they are small; what does not lie flat then
// is cut again. kSmall: the largest area of such a chart, as a share of the whole.
constexpr float kSmallCone = 0.0f, kSmall = 0.02f;
constexpr float kTurning = 8;      // weight of the turn of the normal against the distance walked
constexpr int kRounds = 6;         // number of times that the seeds are moved
constexpr int kSmoothPasses = 12;  // passes that shorten the borders

struct Seed {
  uint32_t face;
  Vec3f axis;
};

// A face that may be reached next. Ties are broken by ids, so that the order is always the same.
struct Step {
  float cost;
  uint32_t face, chart;
  bool operator>(const Step& o) const {
    return cost != o.cost ? cost > o.cost : face != o.face ? face > o.face : chart > o.chart;
  }
};

class Grower {
 public:
  explicit Grower(const FaceGraph& graph) : graph_(graph), chart_(graph.size(), kNone) {}

  std::vector<Seed> seeds;
  const std::vector<uint32_t>& charts() const { return chart_; }

  // All charts at once from their seeds, as far as their cones reach.
  void grow() {
    std::fill(chart_.begin(), chart_.end(), kNone);
    for (uint32_t c = 0; c < seeds.size(); ++c) steps_.push({0, seeds[c].face, c});
    run();
  }

  // A new chart for every face that is in none.
  void fill() {
    for (uint32_t f = 0; f < chart_.size(); ++f) {
      if (chart_[f] != kNone) continue;
      seeds.push_back({f, graph_.normals[f]});
      steps_.push({0, f, uint32_t(seeds.size() - 1)});
      run();
    }
  }

  // Seeds and axes to the middles of their charts.
  void recenter() {
    std::vector<Vec3f> centers(seeds.size(), {0, 0, 0}), axes = centers;
    std::vector<float> areas(seeds.size(), 0.0f);
    for (uint32_t f = 0; f < chart_.size(); ++f) {
      const float a = graph_.areas[f] + std::numeric_limits<float>::min();
      centers[chart_[f]] += graph_.centers[f] * a;
      axes[chart_[f]] += graph_.normals[f] * a;
      areas[chart_[f]] += a;
    }
    std::vector<float> nearest(seeds.size(), std::numeric_limits<float>::infinity());
    for (uint32_t f = 0; f < chart_.size(); ++f) {
      const uint32_t c = chart_[f];
      const Vec3f axis = normalize(axes[c]);
      const float away = length(graph_.centers[f] - centers[c] / areas[c]) *
                         (1 + kTurning * (1 - dot(graph_.normals[f], axis)));
      if (!(away < nearest[c])) continue;
      nearest[c] = away;
      seeds[c] = {f, axis};
    }
  }

 private:
  void run() {
    while (!steps_.empty()) {
      const Step s = steps_.top();
      steps_.pop();
      if (chart_[s.face] != kNone) continue;
      chart_[s.face] = s.chart;
      const Vec3f axis = seeds[s.chart].axis;
      for (const uint32_t g : graph_.across[s.face]) {
        if (g == kNoFace || chart_[g] != kNone) continue;
        const float cosine = dot(graph_.normals[g], axis);
        if (cosine < kCone) continue;
        const float way = length(graph_.centers[g] - graph_.centers[s.face]);
        steps_.push({s.cost + way * (1 + kTurning * (1 - cosine)), g, s.chart});
      }
    }
  }

  const FaceGraph& graph_;
  std::vector<uint32_t> chart_;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps_;
};

// Joins charts, the smallest first, to that neighbor with which they share most of their border.
class Joiner {
 public:
  Joiner(const FaceGraph& graph, std::vector<uint32_t>& chart, uint32_t count)
      : graph_(graph), chart_(chart), faces_(count), area_(count, 0.0f) {
    for (uint32_t f = 0; f < chart.size(); ++f) {
      faces_[chart[f]].push_back(f);
      area_[chart[f]] += graph.areas[f];
    }
  }

  // largest: area of the charts that are joined to others; cone: see kCone.
  void join(float largest, float cone) {
    cone_ = cone;
    std::priority_queue<std::pair<float, uint32_t>, std::vector<std::pair<float, uint32_t>>, std::greater<>>
        order;
    for (uint32_t c = 0; c < faces_.size(); ++c) order.push({area_[c], c});
    while (!order.empty()) {
      const auto [area, c] = order.top();
      order.pop();
      if (area != area_[c] || faces_[c].empty()) continue;  // has become another one since
      if (area > largest) return;
      const uint32_t into = best_neighbor(c);
      if (into == kNone) continue;
      take(into, c);
      order.push({area_[into], into});
    }
  }

 private:
  std::map<uint32_t, float> shared_borders(uint32_t c) const {
    std::map<uint32_t, float> shared;
    for (const uint32_t f : faces_[c])
      for (int k = 0; k < 3; ++k) {
        const uint32_t g = graph_.across[f][k];
        if (g != kNoFace && chart_[g] != c) shared[chart_[g]] += graph_.edges[f][k];
      }
    return shared;
  }

  uint32_t best_neighbor(uint32_t c) const {
    float longest = -1;
    uint32_t best = kNone;
    for (const auto& [d, shared] : shared_borders(c))
      if (shared > longest && in_one_cone(c, d)) longest = shared, best = d;
    return best;
  }

  Vec3f sum_of_normals(uint32_t c) const {
    Vec3f sum{0, 0, 0};
    for (const uint32_t f : faces_[c]) sum += graph_.normals[f] * graph_.areas[f];
    return sum;
  }

  bool in_one_cone(uint32_t c, uint32_t d) const {
    const Vec3f axis = normalize(sum_of_normals(c) + sum_of_normals(d));
    const auto fits = [&](uint32_t f) { return dot(graph_.normals[f], axis) >= cone_; };
    return std::all_of(faces_[c].begin(), faces_[c].end(), fits) &&
           std::all_of(faces_[d].begin(), faces_[d].end(), fits);
  }

  void take(uint32_t into, uint32_t c) {
    for (const uint32_t f : faces_[c]) chart_[f] = into;
    faces_[into].insert(faces_[into].end(), faces_[c].begin(), faces_[c].end());
    faces_[c].clear();
    area_[into] += area_[c];
  }

  const FaceGraph& graph_;
  std::vector<uint32_t>& chart_;
  std::vector<std::vector<uint32_t>> faces_;
  std::vector<float> area_;
  float cone_ = kCone;
};

std::vector<Vec3f> axes_of(const FaceGraph& graph, const std::vector<uint32_t>& chart, uint32_t count) {
  std::vector<Vec3f> axes(count, {0, 0, 0});
  for (uint32_t f = 0; f < chart.size(); ++f) axes[chart[f]] += graph.normals[f] * graph.areas[f];
  for (Vec3f& a : axes) a = normalize(a);
  return axes;
}

// The chart that most of the border of a face belongs to, if the face hangs on its own by one edge at most:
// without it, its own chart stays in one piece. Else its own.
uint32_t better_chart(const FaceGraph& graph, const std::vector<uint32_t>& chart, uint32_t f) {
  float own = 0, other[3] = {0, 0, 0};
  int own_edges = 0, best = -1;
  const auto& across = graph.across[f];
  for (int k = 0; k < 3; ++k) {
    if (across[k] == kNoFace) continue;
    const uint32_t c = chart[across[k]];
    if (c == chart[f]) own += graph.edges[f][k], ++own_edges;
    for (int j = 0; j < 3 && c != chart[f]; ++j)
      if (across[j] != kNoFace && chart[across[j]] == c) other[k] += graph.edges[f][j];
    if (best < 0 || other[k] > other[best]) best = k;
  }
  return best >= 0 && own_edges <= 1 && other[best] > own ? chart[across[best]] : chart[f];
}

// Faces go over where that shortens the border.
void cut_teeth(const FaceGraph& graph, std::vector<uint32_t>& chart, uint32_t count) {
  const std::vector<Vec3f> axes = axes_of(graph, chart, count);
  for (int pass = 0; pass < kSmoothPasses; ++pass) {
    bool changed = false;
    for (uint32_t f = 0; f < chart.size(); ++f) {
      const uint32_t c = better_chart(graph, chart, f);
      if (c == chart[f] || dot(graph.normals[f], axes[c]) < kCone) continue;
      chart[f] = c;
      changed = true;
    }
    if (!changed) return;
  }
}

// Charts numbered by their first faces; those in several parts become several.
Charts numbered(const FaceGraph& graph, const std::vector<uint32_t>& chart) {
  Charts out{std::vector<uint32_t>(chart.size(), kNone), 0};
  std::vector<uint32_t> open;
  for (uint32_t first = 0; first < chart.size(); ++first) {
    if (out.of_face[first] != kNone) continue;
    out.of_face[first] = out.count;
    open.assign(1, first);
    while (!open.empty()) {
      const uint32_t f = open.back();
      open.pop_back();
      for (const uint32_t g : graph.across[f])
        if (g != kNoFace && chart[g] == chart[f] && out.of_face[g] == kNone)
          out.of_face[g] = out.count, open.push_back(g);
    }
    ++out.count;
  }
  return out;
}

}  // namespace

std::vector<std::vector<uint32_t>> Charts::faces() const {
  std::vector<std::vector<uint32_t>> out(count);
  for (uint32_t f = 0; f < of_face.size(); ++f) out[of_face[f]].push_back(f);
  return out;
}

Charts grow_charts(const FaceGraph& graph) {
  Grower grower(graph);
  grower.fill();
  for (int round = 0; round < kRounds; ++round) {
    grower.recenter();
    grower.grow();
    grower.fill();
  }
  std::vector<uint32_t> chart = grower.charts();
  const uint32_t count = uint32_t(grower.seeds.size());
  Joiner joiner(graph, chart, count);
  joiner.join(std::numeric_limits<float>::infinity(), kCone);
  joiner.join(kSmall * std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0f), kSmallCone);
  cut_teeth(graph, chart, count);
  return numbered(graph, chart);
}

std::vector<std::vector<uint32_t>> connected_parts(const FaceGraph& graph, std::span<const uint32_t> faces) {
  std::map<uint32_t, uint32_t> part;  // of each face of the set
  for (const uint32_t f : faces) part[f] = kNone;
  std::vector<std::vector<uint32_t>> out;
  std::vector<uint32_t> open;
  for (const uint32_t first : faces) {
    if (part[first] != kNone) continue;
    part[first] = uint32_t(out.size());
    out.emplace_back();
    open.assign(1, first);
    while (!open.empty()) {
      const uint32_t f = open.back();
      open.pop_back();
      out.back().push_back(f);
      for (const uint32_t g : graph.across[f]) {
        const auto at = g == kNoFace ? part.end() : part.find(g);
        if (at != part.end() && at->second == kNone) at->second = part[f], open.push_back(g);
      }
    }
  }
  for (auto& p : out) std::sort(p.begin(), p.end());
  return out;
}

}  // namespace cei3d
