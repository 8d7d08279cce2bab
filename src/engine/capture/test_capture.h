// SPDX-License-Identifier: Apache-2.0
// For tests: a small capture of a known ball, written in every format we read.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/json.h"
#include "engine/io/image_file.h"
#include "engine/synthetic/picture.h"
#include "engine/synthetic/views.h"
#include "model/scene/view.h"

namespace cei3d {

struct TestBall {
  Vec3d center{0.3, -0.2, 0.5};  // input frame
  double radius = 1.3;
};

struct TestView {
  std::string stem;  // "r_003"
  Camera camera;
};

// n cameras on a spiral around the ball, z up, each aimed a little beside its center.
inline std::vector<TestView> test_views(const TestBall& ball, int n, int width = 64, int height = 48) {
  std::vector<TestView> views;
  for (int i = 0; i < n; ++i) {
    const double phi = 2.4 * i, z = -0.5 + 1.3 * (i + 0.5) / n, r = std::sqrt(1 - z * z);
    const Vec3d out{r * std::cos(phi), r * std::sin(phi), z};
    const Vec3d aim = ball.center + Vec3d{std::cos(3.0 * i), std::sin(5.0 * i), 0.3} * (0.1 * ball.radius);
    std::string stem = std::to_string(1000 + i).replace(0, 1, "r_");
    views.push_back(
        {stem, look_at(ball.center + out * (4.5 * ball.radius), aim, {width, height, 1.4 * width})});
  }
  return views;
}

// RGBA, sRGB values, straight alpha; the ball is shaded by its normal.
inline Image ball_image(const TestBall& ball, Camera camera) {
  constexpr float kRadius = 0.9f;  // in the frame of synthetic bodies
  camera.center = (camera.center - ball.center) * (double(kRadius) / ball.radius);
  return draw_unlit(*ball_shape(kRadius).body, camera, [](Vec3f p) {
    return Vec3f{0.5f, 0.5f, 0.5f} + p * (0.4f / kRadius);
  });
}

// transforms_<split>.json and <split>/r_000.png ...
inline void write_nerf_split(const std::filesystem::path& folder, const std::string& split,
                             const TestBall& ball, const std::vector<TestView>& views) {
  Json j{{"camera_angle_x", 2 * std::atan(0.5 * views[0].camera.width / views[0].camera.fx)},
         {"frames", Json::array()}};
  for (const TestView& v : views) {
    j["frames"].push_back(nerf_frame("./" + split + "/" + v.stem, v.camera));
    write_png(folder / split / (v.stem + ".png"), ball_image(ball, v.camera));
  }
  write_file_atomic(folder / ("transforms_" + split + ".json"), j.dump(1));
}

// cam_dict_norm.json, image/, mask/ in `folder`.
inline void write_physg(const std::filesystem::path& folder, const TestBall& ball,
                        const std::vector<TestView>& views) {
  Json j = Json::object();
  for (const TestView& v : views) {
    const Camera& c = v.camera;
    const Mat3d r = transpose(c.world_from_cam);
    const Vec3d t = -(r * c.center);
    Json w2c = Json::array();
    for (int i = 0; i < 3; ++i)
      for (const double x : {r.row[i].x, r.row[i].y, r.row[i].z, t[i]}) w2c.push_back(x);
    for (const double x : {0.0, 0.0, 0.0, 1.0}) w2c.push_back(x);
    j[v.stem + ".png"] = {
        {"K", {c.fx, c.skew, c.cx - 0.5, 0, 0, c.fy, c.cy - 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
        {"W2C", w2c},
        {"img_size", {c.width, c.height}}};
    const Image rgba = ball_image(ball, c);
    Image rgb(c.width, c.height, 3), mask(c.width, c.height, 1);
    for (size_t i = 0; i < mask.data.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) rgb.data[3 * i + k] = rgba.data[4 * i + k];
      mask.data[i] = rgba.data[4 * i + 3];
    }
    write_png(folder / "image" / (v.stem + ".png"), rgb);
    write_png(folder / "mask" / (v.stem + ".png"), mask);
  }
  write_file_atomic(folder / "cam_dict_norm.json", j.dump(1));
}

}  // namespace cei3d
