// SPDX-License-Identifier: Apache-2.0
// For tests: the ball of test_capture.h as the programs that find camera poses write it. Images:
// images/r_000.png, RGBA.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/json.h"
#include "engine/capture/test_capture.h"
#include "engine/capture/test_npz.h"
#include "engine/capture/words.h"
#include "model/scene/view.h"

namespace cei3d {

inline void write_images(const std::filesystem::path& folder, const TestBall& ball,
                         const std::vector<TestView>& views) {
  for (const TestView& v : views) write_png(folder / (v.stem + ".png"), ball_image(ball, v.camera));
}

// w, x, y, z. [Shepperd 1978]
inline std::array<double, 4> quaternion_of(const Mat3d& r) {
  const Vec3d diagonal{r.row[0].x, r.row[1].y, r.row[2].z};
  const double trace = diagonal.x + diagonal.y + diagonal.z;
  if (trace > 0) {
    const double w = std::sqrt(1 + trace) / 2;
    return {w, (r.row[2].y - r.row[1].z) / (4 * w), (r.row[0].z - r.row[2].x) / (4 * w),
            (r.row[1].x - r.row[0].y) / (4 * w)};
  }
  int i = diagonal.y > diagonal.x ? 1 : 0;
  if (diagonal.z > diagonal[i]) i = 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = std::sqrt(1 + r.row[i][i] - r.row[j][j] - r.row[k][k]) / 2;
  std::array<double, 4> q{};
  q[0] = (r.row[k][j] - r.row[j][k]) / (4 * s);
  q[size_t(1 + i)] = s;
  q[size_t(1 + j)] = (r.row[j][i] + r.row[i][j]) / (4 * s);
  q[size_t(1 + k)] = (r.row[k][i] + r.row[i][k]) / (4 * s);
  return q;
}

// A COLMAP model of the views: one camera for each view, of the model with this id and these parameters
// behind the principal point; `points` lie on the ball, and every view has those on its side of it.
struct TestColmap {
  int model = 1;
  std::string model_name = "PINHOLE";
  std::vector<double> lens;
  LensDistortion distortion;  // what `lens` means
  std::vector<Vec3d> points;
};

inline std::vector<Vec3d> points_on_ball(const TestBall& ball, int n) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double z = -0.9 + 1.8 * (i + 0.5) / n, phi = 2.4 * i, r = std::sqrt(1 - z * z);
    points.push_back(ball.center + Vec3d{r * std::cos(phi), r * std::sin(phi), z} * ball.radius);
  }
  return points;
}

struct TestObservation {
  Vec2d pixel;
  uint64_t point;  // its id: index + 1
};
inline std::vector<TestObservation> observations_of(const TestBall& ball, const Camera& c,
                                                    const TestColmap& m) {
  std::vector<TestObservation> seen;
  const PhotoCamera photo(c, m.distortion);
  for (size_t i = 0; i < m.points.size(); ++i)
    if (dot(m.points[i] - ball.center, c.center - m.points[i]) > 0)
      if (const auto p = project(photo, m.points[i])) seen.push_back({*p, i + 1});
  return seen;
}

inline std::vector<double> colmap_params(const Camera& c, const TestColmap& m) {
  const bool one_focal = m.model == 0 || m.model == 2 || m.model == 3 || m.model == 8 || m.model == 9;
  std::vector<double> p = one_focal ? std::vector<double>{c.fx} : std::vector<double>{c.fx, c.fy};
  p.insert(p.end(), {c.cx, c.cy});
  p.insert(p.end(), m.lens.begin(), m.lens.end());
  return p;
}

inline void write_colmap_bin(const std::filesystem::path& folder, const TestBall& ball,
                             const std::vector<TestView>& views, const TestColmap& m = {}) {
  std::string cameras, images, points;
  append_bytes(cameras, uint64_t(views.size()));
  append_bytes(images, uint64_t(views.size()));
  for (size_t i = views.size(); i-- > 0;) {  // COLMAP's order is not that of the names
    const Camera& c = views[i].camera;
    append_bytes(cameras, uint32_t(i + 1));
    append_bytes(cameras, int32_t(m.model));
    append_bytes(cameras, uint64_t(c.width));
    append_bytes(cameras, uint64_t(c.height));
    append_bytes(cameras, colmap_params(c, m));
    const Mat3d r = transpose(c.world_from_cam);
    const Vec3d t = -(r * c.center);
    append_bytes(images, uint32_t(i + 7));
    append_bytes(images, quaternion_of(r));
    append_bytes(images, std::array<double, 3>{t.x, t.y, t.z});
    append_bytes(images, uint32_t(i + 1));
    images += views[i].stem + ".png" + '\0';
    const auto seen = observations_of(ball, c, m);
    append_bytes(images, uint64_t(seen.size() + 1));
    append_bytes(images, std::array<double, 2>{3, 4});
    append_bytes(images, ~uint64_t(0));  // a feature that was not triangulated
    for (const TestObservation& o : seen) {
      append_bytes(images, std::array<double, 2>{o.pixel.x, o.pixel.y});
      append_bytes(images, o.point);
    }
  }
  append_bytes(points, uint64_t(m.points.size()));
  for (size_t i = 0; i < m.points.size(); ++i) {
    append_bytes(points, uint64_t(i + 1));
    append_bytes(points, std::array<double, 3>{m.points[i].x, m.points[i].y, m.points[i].z});
    points += std::string(3, 'x') + std::string(8, '\0');
    append_bytes(points, uint64_t(0));
  }
  write_file_atomic(folder / "cameras.bin", cameras);
  write_file_atomic(folder / "images.bin", images);
  write_file_atomic(folder / "points3D.bin", points);
}

inline void write_colmap_txt(const std::filesystem::path& folder, const TestBall& ball,
                             const std::vector<TestView>& views, const TestColmap& m = {}) {
  std::string cameras = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n", images = "# two lines an image\n",
              points = "# points\n";
  for (size_t i = views.size(); i-- > 0;) {
    const Camera& c = views[i].camera;
    cameras += fmt::format("{} {} {} {}", i + 1, m.model_name, c.width, c.height);
    for (const double p : colmap_params(c, m)) cameras += fmt::format(" {:.17g}", p);
    cameras += "\n";
    const Mat3d r = transpose(c.world_from_cam);
    const Vec3d t = -(r * c.center);
    const auto q = quaternion_of(r);
    images += fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {} {}.png\n", i + 7,
                          q[0], q[1], q[2], q[3], t.x, t.y, t.z, i + 1, views[i].stem);
    for (const TestObservation& o : observations_of(ball, c, m))
      images += fmt::format("{:.17g} {:.17g} {} ", o.pixel.x, o.pixel.y, o.point);
    images += "\n";
  }
  for (size_t i = 0; i < m.points.size(); ++i)
    points += fmt::format("{} {:.17g} {:.17g} {:.17g} 9 9 9 0.5 7 0\n", i + 1, m.points[i].x, m.points[i].y,
                          m.points[i].z);
  write_file_atomic(folder / "cameras.txt", cameras);
  write_file_atomic(folder / "images.txt", images);
  write_file_atomic(folder / "points3D.txt", points);
}

// Changes the parameters of every camera in cameras.txt, which all have `count`.
inline void change_colmap_cameras(const std::filesystem::path& folder, size_t count,
                                  const std::function<void(std::vector<double>&)>& change) {
  std::string text;
  const std::string cameras = read_file(folder / "cameras.txt");
  for (Lines lines(cameras); lines.next_data();) {
    Words words(lines.line(), "x");
    for (int i = 0; i < 4; ++i) text += std::string(words.word()) + " ";
    std::vector<double> params(count);
    for (double& p : params) p = words.number();
    change(params);
    for (const double p : params) text += fmt::format("{:.17g} ", p);
    text += "\n";
  }
  write_file_atomic(folder / "cameras.txt", text);
}

// Metashape's XML: the calibration once, OpenCV's p1 and p2 swapped, principal point from the middle.
inline void write_metashape(const std::filesystem::path& folder, const std::vector<TestView>& views,
                            const LensDistortion& lens = {}) {
  const Camera& k = views[0].camera;
  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n<document version=\"2.0.0\"><chunk label=\"Chunk 1\"><sensors><sensor "
      "id=\"3\" "
      "type=\"frame\"><resolution width=\"{}\" height=\"{}\"/><calibration type=\"frame\" class=\"adjusted\">"
      "<f>{:.17g}</f><cx>{:.17g}</cx><cy>{:.17g}</cy><b1>{:.17g}</b1><k1>{}</k1><k2>{}</k2><p1>{}</"
      "p1><p2>{}</p2>"
      "</calibration></sensor></sensors><cameras>",
      k.width, k.height, k.fy, k.cx - k.width / 2.0, k.cy - k.height / 2.0, k.fx - k.fy, lens.radial[0],
      lens.radial[1], lens.p2, lens.p1);
  for (size_t i = 0; i < views.size(); ++i) {
    const Camera& c = views[i].camera;
    xml += fmt::format("<camera id=\"{}\" sensor_id=\"3\" label=\"{}\"><transform>", i, views[i].stem);
    for (int r = 0; r < 3; ++r)
      for (const double v :
           {c.world_from_cam.row[r].x, c.world_from_cam.row[r].y, c.world_from_cam.row[r].z, c.center[r]})
        xml += fmt::format("{:.17g} ", v);
    xml += "0 0 0 1</transform></camera>";
  }
  xml += "<camera id=\"99\" sensor_id=\"3\" label=\"unaligned\"/></cameras></chunk></document>";
  write_file_atomic(folder / "cameras.xml", xml);
}

// RealityCapture's CSV. Angles in degrees, of the OpenGL camera: Rz(-heading) Rx(pitch) Ry(roll).
inline void write_realitycapture(const std::filesystem::path& folder, const std::vector<TestView>& views) {
  std::string csv = "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n";
  for (const TestView& v : views) {
    const Camera& c = v.camera;
    Mat3d m = c.world_from_cam;
    for (Vec3d& row : m.row) row = {row.x, -row.y, -row.z};
    const double d = 180 / M_PI, side = std::max(c.width, c.height);
    const double pitch = std::asin(m.row[2].y), roll = std::atan2(-m.row[2].x, m.row[2].z),
                 heading = -std::atan2(-m.row[0].y, m.row[1].y);
    csv += fmt::format(
        "{}.png,{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},0,0,0,0,0,0\n",
        v.stem, c.center.x, c.center.y, c.center.z, heading * d, pitch * d, roll * d, c.fx * 36 / side,
        (c.cx - c.width / 2.0) / side, (c.cy - c.height / 2.0) / side);
  }
  write_file_atomic(folder / "cameras.csv", csv);
}

inline void write_llff(const std::filesystem::path& folder, const std::vector<TestView>& views) {
  std::string data;
  for (const TestView& v : views) {
    const Camera& c = v.camera;
    const double last[3] = {double(c.height), double(c.width), c.fx};
    for (int r = 0; r < 3; ++r) {
      const Vec3d row = c.world_from_cam.row[r];
      append_bytes(data, std::array<double, 5>{row.y, row.x, -row.z, c.center[r], last[r]});
    }
    append_bytes(data, std::array<double, 2>{1, 9});
  }
  write_file_atomic(folder / "poses_bounds.npy",
                    test_npy("<f8", fmt::format("({}, 17)", views.size()), data));
}

// Meshroom's JSON, with numbers as texts. absolute: as its versions before 1.2 store intrinsics.
inline void write_meshroom(const std::filesystem::path& folder, const std::vector<TestView>& views,
                           bool absolute) {
  const auto text = [](double v) { return fmt::format("{:.17g}", v); };
  const Camera& k = views[0].camera;
  Json in{{"intrinsicId", "5"}, {"width", std::to_string(k.width)}, {"height", std::to_string(k.height)}};
  in["type"] = "radial3";
  in["distortionParams"] = {"0", "0", "0"};
  if (absolute) {
    in["pxFocalLength"] = text(k.fx);
    in["principalPoint"] = {text(k.cx), text(k.cy)};
  } else {
    in["focalLength"] = text(k.fx * 36 / k.width);
    in["sensorWidth"] = "36";
    in["principalPoint"] = {text(k.cx - k.width / 2.0), text(k.cy - k.height / 2.0)};
  }
  Json j{{"version", {"1", absolute ? "0" : "2", "0"}}, {"intrinsics", {in}}, {"views", Json::array()}};
  for (size_t i = 0; i < views.size(); ++i) {
    const Camera& c = views[i].camera;
    const std::string id = std::to_string(100 + i);
    j["views"].push_back({{"viewId", id},
                          {"poseId", id},
                          {"intrinsicId", "5"},
                          {"path", "C:\\photos\\" + views[i].stem + ".png"}});
    Json rotation = Json::array(), center = Json::array();
    for (int r = 0; r < 3; ++r) {
      for (const double v : {c.world_from_cam.row[r].x, c.world_from_cam.row[r].y, c.world_from_cam.row[r].z})
        rotation.push_back(text(v));
      center.push_back(text(c.center[r]));
    }
    j["poses"].push_back(
        {{"poseId", id}, {"pose", {{"transform", {{"rotation", rotation}, {"center", center}}}}}});
  }
  write_file_atomic(folder / "cameras.sfm", j.dump(1));
}

}  // namespace cei3d
