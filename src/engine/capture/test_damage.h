// SPDX-License-Identifier: Apache-2.0
// For tests: the usual mistakes, made in a copy of a good capture (transforms.json and RGBA images, as
// write_capture() writes it), and what the check should say about each.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/json.h"
#include "core/image/resample.h"
#include "core/math/color.h"
#include "engine/io/image_file.h"

namespace cei3d {

class DamagedCapture {
 public:
  explicit DamagedCapture(const std::filesystem::path& folder)
      : folder_(folder), json_(Json::parse(read_file(folder / "transforms.json"))) {}
  void save() const { write_file_atomic(folder_ / "transforms.json", json_.dump()); }

  size_t size() const { return json_["frames"].size(); }
  Json& frame(size_t i) { return json_["frames"][i]; }
  std::filesystem::path image(size_t i) { return folder_ / frame(i)["file_path"].get<std::string>(); }
  std::string name(size_t i) {
    return std::filesystem::path(frame(i)["file_path"].get<std::string>()).replace_extension().string();
  }
  const std::filesystem::path& folder() const { return folder_; }

  void keep(Json frames) {
    json_["frames"] = std::move(frames);
    json_.erase("train_filenames");
  }
  void every_pose(const std::function<Json(const Json&)>& change) {
    for (Json& f : json_["frames"]) f["transform_matrix"] = change(f["transform_matrix"]);
  }
  void every_number(const char* key, double factor) {
    for (Json& f : json_["frames"]) f[key] = f[key].get<double>() * factor;
  }
  void redraw(size_t i, const std::function<Image(const Image&)>& change) {
    write_png(image(i), change(read_image(image(i))));
  }

 private:
  std::filesystem::path folder_;
  Json json_;
};

// The image whose pixel (x, y) is what `from` says.
inline Image remade(const Image& image, const std::function<Vec2<double>(double, double)>& from) {
  Image out(image.width, image.height, image.channels);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto p = from(x + 0.5, y + 0.5);
      if (p.x >= 0 && p.y >= 0 && p.x < image.width && p.y < image.height)
        std::copy_n(image.at(int(p.x), int(p.y)), image.channels, out.at(x, y));
    }
  return out;
}

inline Image exposed(Image image, float factor) {
  image = linear_from_srgb(std::move(image));
  for (size_t i = 0; i < image.data.size(); ++i)
    if (i % 4 != 3) image.data[i] = std::min(1.0f, image.data[i] * factor);
  return srgb_from_linear(std::move(image));
}

inline Image blurred(const Image& image, int radius) {
  Image out = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        double sum = 0, n = 0;
        for (int v = std::max(0, y - radius); v <= std::min(image.height - 1, y + radius); ++v)
          for (int u = std::max(0, x - radius); u <= std::min(image.width - 1, x + radius); ++u) {
            const double a = image.at(u, v)[3];
            sum += a * image.at(u, v)[c], n += a;
          }
        out.at(x, y)[c] = n > 0 ? float(sum / n) : 0;
      }
  return out;
}

// Middle and radius of the object in an image.
struct ObjectDisc {
  double x = 0, y = 0, radius = 0;
};
inline ObjectDisc object_disc(const Image& image) {
  ObjectDisc d;
  double n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (image.at(x, y)[3] > 0.5f) d.x += x, d.y += y, ++n;
  return {d.x / n, d.y / n, std::sqrt(n / M_PI)};
}

inline Image with_alpha(Image image, const std::function<float(double, double, float)>& alpha) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) image.at(x, y)[3] = alpha(x, y, image.at(x, y)[3]);
  return image;
}

struct Damage {
  const char* name;
  std::function<void(DamagedCapture&)> make;
  std::string says;  // regular expression that a finding's sentence matches
};

inline Json turned_pose(const Json& pose, double radians) {
  Json out = pose;
  for (size_t r = 0; r < 3; ++r) {  // about the camera's own up axis
    const double x = pose[r][0], z = pose[r][2];
    out[r][0] = std::cos(radians) * x - std::sin(radians) * z;
    out[r][2] = std::sin(radians) * x + std::cos(radians) * z;
  }
  return out;
}

// Directions of the cameras from the middle between them, and those within an angle of the first one's
// azimuth.
inline std::vector<size_t> frames_beside_the_first(DamagedCapture& c, double radians) {
  const auto at = [&](size_t i, size_t axis) {
    return c.frame(i)["transform_matrix"][axis][3].get<double>();
  };
  double x = 0, y = 0;
  for (size_t i = 0; i < c.size(); ++i) x += at(i, 0) / double(c.size()), y += at(i, 1) / double(c.size());
  const auto azimuth = [&](size_t i) { return std::atan2(at(i, 1) - y, at(i, 0) - x); };
  std::vector<size_t> beside;
  for (size_t i = 0; i < c.size(); ++i)
    if (std::cos(azimuth(i) - azimuth(0)) > std::cos(radians)) beside.push_back(i);
  return beside;
}

// All cameras are wrong in the same way.
inline void add_mistakes_of_all_cameras(std::vector<Damage>& all) {
  const auto inverse = [](const Json& m) {
    Json out = m;
    for (size_t r = 0; r < 3; ++r) {
      double t = 0;
      for (size_t c = 0; c < 3; ++c) out[r][c] = m[c][r], t -= m[c][r].get<double>() * m[c][3].get<double>();
      out[r][3] = t;
    }
    return out;
  };
  const auto opencv = [](const Json& m) {
    Json out = m;
    for (size_t r = 0; r < 3; ++r)
      for (size_t c = 1; c < 3; ++c) out[r][c] = -m[r][c].get<double>();
    return out;
  };
  all.push_back({"axes", [=](DamagedCapture& c) { c.every_pose(opencv); }, "agree .*y and z axes"});
  all.push_back(
      {"inverse poses", [=](DamagedCapture& c) { c.every_pose(inverse); }, "agree .*world-to-camera"});
  all.push_back({"inverse poses, OpenCV",
                 [=](DamagedCapture& c) { c.every_pose([&](const Json& m) { return inverse(opencv(m)); }); },
                 "agree .*world-to-camera"});
  all.push_back({"focal length in millimeters",
                 [](DamagedCapture& c) {
                   for (size_t i = 0; i < c.size(); ++i)
                     for (const char* key : {"fl_x", "fl_y"})
                       c.frame(i)[key] = c.frame(i)[key].get<double>() * 36 / c.frame(i)["w"].get<double>();
                 },
                 "field of view"});
  all.push_back({"K of another size",
                 [](DamagedCapture& c) {
                   for (const char* key : {"fl_x", "fl_y", "cx", "cy"}) c.every_number(key, 2);
                 },
                 "principal points"});
}

// Image and camera of single views do not belong together.
inline void add_mistakes_of_single_views(std::vector<Damage>& all) {
  all.push_back({"mirrored images",
                 [](DamagedCapture& c) {
                   for (const size_t i : {2, 9})
                     c.redraw(i, [](const Image& m) {
                       return remade(m, [&](double x, double y) { return Vec2<double>{m.width - x, y}; });
                     });
                 },
                 "do not fit the others|masks leave out|masks include"});
  all.push_back({"exchanged images",
                 [](DamagedCapture& c) {
                   const Image a = read_image(c.image(3)), b = read_image(c.image(11));
                   write_png(c.image(3), b), write_png(c.image(11), a);
                 },
                 "2 of .* (do not fit the others|masks include)"});
  all.push_back({"image of another scale",
                 [](DamagedCapture& c) {
                   c.redraw(5, [](const Image& m) {
                     return remade(m, [&](double x, double y) {
                       return Vec2<double>{(x - m.width / 2.0) * 1.5 + m.width / 2.0,
                                           (y - m.height / 2.0) * 1.5 + m.height / 2.0};
                     });
                   });
                 },
                 "do not fit the others|masks leave out"});
  all.push_back({"turned cameras",
                 [](DamagedCapture& c) {
                   for (const size_t i : {4, 13})
                     c.frame(i)["transform_matrix"] = turned_pose(c.frame(i)["transform_matrix"], 0.12);
                 },
                 "2 of .* do not fit the others"});
  all.push_back({"cameras of another scale",
                 [](DamagedCapture& c) {
                   for (const size_t i : {1, 6, 12})
                     for (size_t r = 0; r < 3; ++r)
                       c.frame(i)["transform_matrix"][r][3] =
                           1.6 * c.frame(i)["transform_matrix"][r][3].get<double>();
                 },
                 "do not fit the others|masks (leave out|include)"});
}

inline void add_mistakes_of_photographs(std::vector<Damage>& all) {
  all.push_back({"inverted alpha",
                 [](DamagedCapture& c) {
                   for (size_t i = 0; i < c.size(); ++i)
                     c.redraw(i, [](const Image& m) {
                       return with_alpha(m, [](double, double, float a) { return 1 - a; });
                     });
                 },
                 "mean the background"});
  all.push_back({"exposure",
                 [](DamagedCapture& c) {
                   for (const size_t i : {3, 8})
                     c.redraw(i, [](const Image& m) { return exposed(m, 0.45f); });
                 },
                 "brighter or darker"});
  all.push_back({"blur", [](DamagedCapture& c) { c.redraw(7, [](const Image& m) { return blurred(m, 4); }); },
                 "1 of .* blurred"});
  all.push_back({"the same image twice",
                 [](DamagedCapture& c) { write_file_atomic(c.image(6), read_file(c.image(2))); },
                 "there twice"});
}

inline void add_mistakes_of_masks(std::vector<Damage>& all) {
  all.push_back({"hole in a mask",
                 [](DamagedCapture& c) {
                   c.redraw(4, [](const Image& m) {
                     const ObjectDisc d = object_disc(m);
                     return with_alpha(m, [&](double x, double y, float a) {
                       return std::hypot(x - d.x, y - d.y) < 0.4 * d.radius ? 0 : a;
                     });
                   });
                 },
                 "1 of .* masks leave out"});
  all.push_back({"half a mask missing",
                 [](DamagedCapture& c) {
                   c.redraw(10, [](const Image& m) {
                     const ObjectDisc d = object_disc(m);
                     return with_alpha(m, [&](double x, double, float a) { return x < d.x ? 0 : a; });
                   });
                 },
                 "1 of .* masks leave out"});
  all.push_back({"mask with too much",
                 [](DamagedCapture& c) {
                   c.redraw(8, [](const Image& m) {
                     const ObjectDisc d = object_disc(m);
                     return with_alpha(m, [&](double x, double y, float a) {
                       return std::hypot(x - 0.12 * m.width, y - 0.12 * m.height) < 0.35 * d.radius ? 1 : a;
                     });
                   });
                 },
                 "1 of .* masks include"});
  all.push_back(
      {"empty mask",
       [](DamagedCapture& c) {
         c.redraw(5, [](const Image& m) { return with_alpha(m, [](double, double, float) { return 0; }); });
       },
       "masks are empty"});
}

inline void add_mistakes_of_files(std::vector<Damage>& all) {
  all.push_back({"missing images",
                 [](DamagedCapture& c) {
                   for (size_t i = 0; i < c.size(); i += 5) std::filesystem::remove(c.image(i));
                 },
                 "images are missing"});
  all.push_back({"truncated image",
                 [](DamagedCapture& c) {
                   const std::string bytes = read_file(c.image(3));
                   write_file_atomic(c.image(3), bytes.substr(0, bytes.size() / 2));
                 },
                 "cannot be used"});
  all.push_back({"cropped image",
                 [](DamagedCapture& c) {
                   c.redraw(3, [](const Image& m) {
                     Image out(m.width * 2 / 3, m.height, 4);
                     for (int y = 0; y < out.height; ++y)
                       std::copy_n(m.at(0, y), out.width * 4, out.at(0, y));
                     return out;
                   });
                 },
                 "cannot be used"});
  all.push_back({"pose with NaN", [](DamagedCapture& c) { c.frame(2)["transform_matrix"][0][3] = nullptr; },
                 "poses are not a rotation"});
  all.push_back({"image turned by 90 degrees",
                 [](DamagedCapture& c) { c.redraw(6, [](const Image& m) { return turned(m, 6); }); },
                 "cannot be used|turned by .* degrees|do not fit the others"});
}

// Too few photographs, or one of another size.
inline void add_mistakes_of_coverage(std::vector<Damage>& all) {
  all.push_back({"too few views",
                 [](DamagedCapture& c) {
                   for (size_t i = 9; i < c.size(); ++i) std::filesystem::remove(c.image(i));
                   Json few = Json::array();
                   for (size_t i = 0; i < 9; ++i) few.push_back(c.frame(i));
                   c.keep(few);
                 },
                 "only 9 training views"});
  all.push_back({"a side without photographs",
                 [](DamagedCapture& c) {
                   const std::vector<size_t> gone = frames_beside_the_first(c, 1.2);
                   Json left = Json::array();
                   for (size_t i = 0; i < c.size(); ++i)
                     if (std::find(gone.begin(), gone.end(), i) == gone.end()) left.push_back(c.frame(i));
                   c.keep(left);
                 },
                 "side of the object is not photographed"});
  all.push_back({"image of half the size",
                 [](DamagedCapture& c) { c.redraw(5, [](const Image& m) { return downscale(m, 2); }); },
                 "cameras of 1 of .* were scaled to their images"});
}

inline std::vector<Damage> usual_damages() {
  std::vector<Damage> all;
  add_mistakes_of_all_cameras(all);
  add_mistakes_of_single_views(all);
  add_mistakes_of_photographs(all);
  add_mistakes_of_masks(all);
  add_mistakes_of_files(all);
  add_mistakes_of_coverage(all);
  return all;
}

}  // namespace cei3d
