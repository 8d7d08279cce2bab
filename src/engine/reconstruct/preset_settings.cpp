// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/preset_settings.h"

#include <algorithm>

namespace cei3d {
namespace {

template <class Owner>
using Group = SettingGroup<Preset, Owner>;

constexpr const char* kNeus = "[Wang et al. 2021]";
constexpr const char* kHashGrid = "[Mueller et al. 2022]";
constexpr const char* kAdam = "[Kingma and Ba 2015]";
constexpr const char* kPaper = "[paper sec. 5.1]";
constexpr const char* kPaperPreset = "[paper sec. 5.1] in preset paper";  // other presets differ

void add_network(const Group<FieldConfig>& g) {
  g.part("encoding.", &FieldConfig::encoding)
      .add("frequencies", &EncodingConfig::frequencies, {0, 16}, "",
           "Frequencies of sine and cosine of the position", "[Mildenhall et al. 2020]")
      .add("levels", &EncodingConfig::levels, {0, 24}, "", "Levels of the hash grid; 0: none", kHashGrid)
      .add("base_resolution", &EncodingConfig::base_resolution, {4, 512}, "cells an axis",
           "Resolution of the first level of the hash grid", kHashGrid)
      .add("finest_resolution", &EncodingConfig::finest_resolution, {4, 4096}, "cells an axis",
           "Resolution of the last level of the hash grid")
      .add("log2_table", &EncodingConfig::log2_table, {8, 22}, "",
           "Binary logarithm of the number of entries of a level", kHashGrid);
  g.add("hidden_layers", &FieldConfig::hidden_layers, {0, 16}, "", "Hidden layers of the network",
        kPaperPreset)
      .add("width", &FieldConfig::width, {1, 1024}, "neurons", "Width of a hidden layer", kPaperPreset)
      .add("skip_layer", &FieldConfig::skip_layer, {-1, 15}, "",
           "Hidden layer that reads the encoding again; -1: none", "[Yariv et al. 2020]")
      .choice("activation", &FieldConfig::activation,
              {{Activation::relu, "relu"}, {Activation::softplus, "softplus"}, {Activation::elu, "elu"}},
              "Activation function of the hidden layers")
      .add("softplus_beta", &FieldConfig::softplus_beta, {1, 1000}, "",
           "Sharpness of the activation softplus", "[Yariv et al. 2020]");
}

void add_losses(const Group<GeometryLosses>& g) {
  g.add("huber_width", &GeometryLosses::huber_width, {1e-6, 10}, "sRGB, 0 to 1",
        "Color error from which the color loss grows linearly", "[Huber 1964]")
      .add("eikonal", &GeometryLosses::eikonal, {0, 100}, "",
           "Weight of the eikonal loss, (|gradient| - 1)^2", "[Gropp et al. 2020]")
      .add("empty", &GeometryLosses::empty, {0, 100}, "",
           "Weight of the loss that keeps background rays free of surface")
      .add("anchor", &GeometryLosses::anchor, {0, 100}, "",
           "Weight of the loss that holds the field at the start shape");
}

void add_sampling(const Group<SamplingOptions>& g) {
  g.add("step_min", &SamplingOptions::step_min, {1e-4, 0.5}, "object radii",
        "Shortest distance between samples")
      .add("step_max", &SamplingOptions::step_max, {1e-4, 0.5}, "object radii",
           "Longest distance between samples")
      .add("step_width", &SamplingOptions::step_width, {0.05, 50}, "standard deviations of the opacity",
           "Distance between samples, within step_min and step_max")
      .add("keep_weight", &SamplingOptions::keep_weight, {0, 0.5}, "",
           "Weight in the color of a ray below which a sample is skipped");
}

void add_adam(const Group<AdamConstants>& g) {
  g.add("beta2", &AdamConstants::beta2, {0, 0.9999999}, "", "Decay of Adam's mean squared gradient", kAdam)
      .add("eps", &AdamConstants::eps, {0, 1}, "",
           "Number that Adam adds to the root of the mean squared gradient", kAdam);
}

void add_schedule(const Group<GeometryOptions>& g) {
  constexpr SettingRange kPosition{1e-3, 1};  // in the schedule
  g.add("rays", &GeometryOptions::rays, {kChunkRays, 65536, kChunkRays}, "rays a step",
        "Size of a training batch", kPaper)
      .add("inv_s_start", &GeometryOptions::inv_s_start, {1, 1e5}, "1 / object radius",
           "Inverse standard deviation of the opacity at the beginning", kNeus)
      .add("inv_s_end", &GeometryOptions::inv_s_end, {1, 1e5}, "1 / object radius",
           "Inverse standard deviation of the opacity at the end", kNeus)
      .add("inv_s_until", &GeometryOptions::inv_s_until, kPosition, "of the schedule",
           "Position at which the inverse standard deviation reaches its last value")
      .add("unlock_until", &GeometryOptions::unlock_until, kPosition, "of the schedule",
           "Position from which all levels of the hash grid are in use", "[Wang et al. 2023]")
      .add("first_levels", &GeometryOptions::first_levels, {1, 24}, "",
           "Levels of the hash grid in use from the beginning")
      .add("decay_from", &GeometryOptions::decay_from, {0, 0.999}, "of the schedule",
           "Position at which rates begin to decay")
      .add("decay_to", &GeometryOptions::decay_to, {1e-6, 1}, "", "Factor of the rates at the end")
      .add("halving_parts", &GeometryOptions::halving_parts, {0, 1000}, "",
           "Parts of the schedule after each of which rates are halved, in place of the decay; 0: no halving",
           kPaperPreset)
      .add("table_rate", &GeometryOptions::table_rate, {0, 1}, "", "Learning rate of the hash tables", kAdam)
      .add("layer_rate", &GeometryOptions::layer_rate, {0, 1}, "", "Learning rate of the layers", kAdam)
      .add("prefit_steps", &GeometryOptions::prefit_steps, {0, 1e6}, "steps",
           "Training steps that fit the field to the start shape")
      .add("refresh_every", &GeometryOptions::refresh_every, {1, 1e6}, "steps",
           "Training steps between two updates of the occupancy grid")
      .add("tight_grid_from", &GeometryOptions::tight_grid_from, {0, 1}, "of the schedule",
           "Position from which the occupancy grid is trusted more")
      .add("hold_start", &GeometryOptions::hold_start, {}, "",
           "Hold the field at every start shape, also at the visual hull, and all around its surface")
      .add("anchor_until", &GeometryOptions::anchor_until, kPosition, "of the schedule",
           "Position until which the field is held at a start shape");
}

void add_geometry(const Group<GeometryOptions>& g) {
  add_network(g.part("sdf.", &GeometryOptions::sdf));
  g.part("sdf.", &GeometryOptions::sdf)
      .add("sphere_radius", &FieldConfig::sphere_radius, {0, 1}, "object radii",
           "Radius of the sphere that the untrained field is; 0: no sphere", "[Yariv et al. 2020]");
  g.add("radiance_layers", &GeometryOptions::radiance_layers, {1, 8}, "",
        "Hidden layers of the radiance network", kNeus)
      .add("radiance_width", &GeometryOptions::radiance_width, {1, 1024}, "neurons",
           "Width of a hidden layer of the radiance network", kNeus);
  add_schedule(g);
  add_adam(g.part("adam.", &GeometryOptions::adam));
  add_sampling(g.part("sampling.", &GeometryOptions::sampling));
  add_losses(g.part("loss.", &GeometryOptions::loss));
}

void add_shapes(const Group<ShapeOptions>& g) {
  g.add("cells", &ShapeOptions::cells, {16, 512}, "cells an axis",
        "Resolution of the start shapes that masks and colors give")
      .add("stereo_cells", &ShapeOptions::stereo_cells, {16, 512}, "cells an axis",
           "Resolution of the start shape that depth maps give");
  g.part("carving.", &ShapeOptions::carving)
      .add("steps", &CarveOptions::steps, {1, 1e5}, "steps", "Training steps of the densities and colors",
           "[Sun et al. 2022]")
      .add("rays", &CarveOptions::rays, {1, 1e6}, "rays a step", "Size of a training batch")
      .add("density", &CarveOptions::density, {1e-3, 1e3}, "1 / object radius",
           "Density of all cells at the beginning")
      .add("density_rate", &CarveOptions::density_rate, {0, 1}, "",
           "Largest change of a cell's opacity in a step")
      .add("color_rate", &CarveOptions::color_rate, {0, 1}, "sRGB, 0 to 1",
           "Largest change of a cell's color in a step")
      .add("opacity_weight", &CarveOptions::opacity_weight, {0, 100}, "",
           "Weight of the mask loss against the color loss")
      .add("empty_opacity", &CarveOptions::empty_opacity, {0, 1}, "",
           "Opacity below which a lit cell is empty")
      .add("lit", &CarveOptions::lit, {0, 1}, "",
           "Share of a ray's light that has to reach a cell that counts as lit")
      .add("opening", &CarveOptions::opening, {0, 16}, "cells",
           "Half width of the hollows that are removed as noise");
  g.part("stereo.", &ShapeOptions::stereo)
      .add("pixels", &StereoOptions::pixels, {1000, 1e9}, "pixels",
           "Pixels of all depth maps together, at most")
      .add("neighbors", &StereoOptions::neighbors, {2, 32}, "views", "Views that each view is matched with")
      .add("window", &StereoOptions::window, {1, 16}, "pixels", "Half width of the windows that are matched")
      .add("min_score", &StereoOptions::min_score, {-1, 1}, "", "Minimum correlation of a match",
           "[Goesele et al. 2006]")
      .add("agreement", &StereoOptions::agreement, {0, 100}, "planes",
           "Largest difference between the depths of a point in two maps");
}

void add_appearance(const Group<AppearanceOptions>& g) {
  add_network(g.part("albedo.", &AppearanceOptions::albedo));
  add_network(g.part("materials.", &AppearanceOptions::materials));
  g.add("albedo_steps", &AppearanceOptions::albedo_steps, {-1, 1e6}, "steps",
        "Training steps of the albedo under the separated light; -1: by the time of the run")
      .add("refine_steps", &AppearanceOptions::refine_steps, {-1, 1e6}, "steps",
           "Training steps of albedo, material and light together; -1: by the time of the run")
      .add("lobe_steps", &AppearanceOptions::lobe_steps, {0, 1e6}, "steps",
           "Steps of the fit of light lobes to the separated light", "[paper eq. 12]")
      .add("material_steps", &AppearanceOptions::material_steps, {0, 1e6}, "steps",
           "Training steps of the material field")
      .add("roughness", &AppearanceOptions::roughness, {0, 1}, "",
           "Roughness of the object, if it is known; 0: searched")
      .add("batch", &AppearanceOptions::batch, {1, 1e6}, "pixels a step", "Size of a training batch")
      .add("network_rate", &AppearanceOptions::network_rate, {0, 1}, "", "Learning rate of the layers",
           kAdam);
}

void add_joint_rates(const Group<JointOptions>& g) {
  g.part("rates.", &JointOptions::rates)
      .add("sdf_tables", &JointRates::sdf_tables, {0, 1}, "",
           "Learning rate of the hash tables of the distance field", kAdam)
      .add("sdf_layers", &JointRates::sdf_layers, {0, 1}, "",
           "Learning rate of the layers of the distance field", kAdam)
      .add("albedo", &JointRates::albedo, {0, 100}, "1e-2 of tables, 2e-3 of layers",
           "Factor of the learning rates of the albedo", kAdam)
      .add("material", &JointRates::material, {0, 1}, "",
           "Learning rate of the material's logits; 0: the material is constant", kAdam)
      .add("light", &JointRates::light, {0, 100}, "1e-2 of logarithms, 2e-3 of axes",
           "Factor of the learning rates of the light lobes", kAdam);
  g.part("schedule.", &JointOptions::schedule)
      .add("warm_up", &RateSchedule::warm_up, {0, 1}, "of the descent",
           "Part of the descent in which rates rise")
      .add("last", &RateSchedule::last, {1e-6, 1}, "", "Factor of the rates at the end")
      .add("halving_parts", &RateSchedule::halving_parts, {0, 1000}, "",
           "Parts of the descent after each of which rates are halved, in place of the fall to `last`; 0: no "
           "halving",
           kPaperPreset);
  add_adam(g.part("adam.", &JointOptions::adam));
}

void add_joint(const Group<JointOptions>& g) {
  add_joint_rates(g);
  g.choice("color", &JointOptions::color, {{ColorLoss::display, "display"}, {ColorLoss::linear, "linear"}},
           "Color loss: the Huber loss of display-encoded colors, or L1 of linear colors", "[paper eq. 16]")
      .add("weight_norm", &JointOptions::weight_norm, {}, "",
           "Normalize the weights of the distance field's layers", "[Salimans and Kingma 2016]")
      .choice("specular", &JointOptions::specular,
              {{SpecularTerm::split_sum, "split-sum"}, {SpecularTerm::single_sg, "single-sg"}},
              "Specular term: the shading model's, or one spherical Gaussian without occlusion",
              "[paper eq. 14]")
      .add("rays", &JointOptions::rays, {1, 1e6}, "rays a step",
           "Rays through pixels of the object in a training step", kPaperPreset)
      .add("eikonal", &JointOptions::eikonal, {0, 100}, "", "Weight of the eikonal loss, (|gradient| - 1)^2",
           kPaper)
      .add("box_points", &JointOptions::box_points, {0, 1e6}, "points a step",
           "Random points of the object's box at which the eikonal loss is taken", "[paper eq. 16]")
      .add("near_points", &JointOptions::near_points, {0, 1e6}, "points a step",
           "Points near hits at which the eikonal loss is taken, too")
      .add("mask_rays", &JointOptions::mask_rays, {0, 1e6}, "rays a step",
           "Rays around the object in a training step, for the mask loss")
      .add("mask", &JointOptions::mask, {0, 1e4}, "1 / mask_sharpness", "Weight of the mask loss",
           "[Yariv et al. 2020]")
      .add("mask_sharpness", &JointOptions::mask_sharpness, {1, 1e5}, "1 / object radius",
           "Sharpness of the mask loss", "[Yariv et al. 2020]")
      .add("keep_power", &JointOptions::keep_power, {}, "", "Keep the power of the light constant")
      .add("learn_specular", &JointOptions::learn_specular, {}, "", "Train the specular strength")
      .add("refresh", &JointOptions::refresh, {1, 1e6}, "steps",
           "Training steps after which visibility and bounces are computed again");
}

void add_meshing(const Group<MeshingOptions>& g) {
  g.add("resolution", &MeshingOptions::resolution, {16, 1024, 4}, "cells an axis",
        "Resolution of the grid that the mesh is made from", "[Gibson 1998]")
      .add("smallest_part", &MeshingOptions::smallest_part, {0, 1}, "of the triangles",
           "Size below which a separate piece of the mesh is dropped");
}

void add_beginning(const Group<Preset>& g) {
  g.choice("start", &Preset::start,
           {{StartChoice::trials, "trials"}, {StartChoice::hull, "hull"}, {StartChoice::sphere, "sphere"}},
           "Where the field begins: at the best of three start shapes where there is time to try them, at "
           "the visual hull, or as a sphere",
           "[Atzmon and Lipman 2020]")
      .choice("stages", &Preset::stages, {{StageChoice::all, "all"}, {StageChoice::joint, "joint"}},
              "What is trained: the surface, then light and material; or all of them by the joint descent "
              "alone, from a sphere",
              "[paper eq. 16]")
      .choice("color", &Preset::color,
              {{ColorChoice::disentangled, "disentangled"}, {ColorChoice::coupled, "coupled"}},
              "What the object's color is made of: light, albedo and material; or, for comparison, a network "
              "over position and direction alone",
              "[paper sec. 5]")
      .add("start_radius", &Preset::start_radius, {0.05, 0.95}, "object radii",
           "Radius of the sphere where `start` is sphere");
}

void add_run(const Group<Preset>& g) {
  g.add("iterations", &Preset::iterations, {1, 1e8}, "steps",
        "Training steps of the geometry stage, or of the joint descent if it is alone, where neither a time "
        "nor a number of steps is asked for",
        kPaperPreset)
      .add("polish_steps", &Preset::polish_steps, {0, 1e6}, "steps",
           "Training steps of a round of polishing, at most")
      .add("joint_steps", &Preset::joint_steps, {0, 1e6}, "steps",
           "Training steps of a last descent on everything together, at most; 0: no such descent",
           "[paper eq. 16]")
      .add("exposures_from_steps", &Preset::exposures_from_steps, {0, 1e8}, "steps",
           "Training steps after which the model is compared with the exposures of the photographs")
      .add("polish_from_iterations", &Preset::polish_from_iterations, {0, 1e8}, "steps",
           "Training steps of the geometry stage from which a run by steps polishes the surface and makes a "
           "finer mesh")
      .add("trials_from_iterations", &Preset::trials_from_iterations, {0, 1e8}, "steps",
           "Training steps of the geometry stage from which a run by steps compares start shapes")
      .add("residual_steps", &Preset::residual_steps, {1, 1e6}, "steps",
           "Training steps of the network of a coupled color, at most")
      .add("refinement_steps", &Preset::refinement_steps, {1, 1e6}, "steps",
           "Training steps of a refinement of the albedo")
      .add("larger_tables", &Preset::larger_tables, {0, 4}, "",
           "Number that is added to the logarithm of the sizes of hash tables that are fitted to the pixels")
      .add("max_hits", &Preset::max_hits, {100, 1e9}, "pixels",
           "Training pixels of the appearance stage, at most")
      .add("brief_hits", &Preset::brief_hits, {100, 1e9}, "pixels",
           "Training pixels that make the handler points of a joint descent alone, at most")
      .add("max_residual_hits", &Preset::max_residual_hits, {100, 1e9}, "pixels",
           "Training pixels of the network of a coupled color, at most")
      .add("max_residual_pixels", &Preset::max_residual_pixels, {0, 1e9}, "pixels",
           "Pixels of all residual images, at most; photographs with more are reduced; 0: no such images");
}

SettingTable<Preset> make_table() {
  SettingTable<Preset> table;
  const Group<Preset> preset(table, "", [](Preset& p) -> Preset& { return p; });
  add_beginning(preset);
  add_run(preset);
  add_geometry(preset.part("geometry.", &Preset::geometry));
  const Group<TrialOptions> trial = preset.part("trial.", &Preset::trial);
  trial.add("steps", &TrialOptions::steps, {1, 1e6}, "steps", "Training steps from each start shape")
      .add("rays", &TrialOptions::rays, {64, 1e8}, "pixels",
           "Random training pixels by which start shapes are compared")
      .add("focal_error", &TrialOptions::focal_error, {0, 0.5}, "of the focal length",
           "Standard deviation of the focal length that the capture gives; 0: it is right");
  add_shapes(trial.part("shapes.", &TrialOptions::shapes));
  add_geometry(trial.part("geometry.", &TrialOptions::geometry));
  add_appearance(preset.part("appearance.", &Preset::appearance));
  preset.part("polish.", &Preset::polish)
      .add("batch", &PolishOptions::batch, {1, 1e6}, "pixels a step", "Size of a training batch")
      .add("weight", &PolishOptions::weight, {0, 100}, "",
           "Weight of the shading loss against the loss of the geometry stage")
      .add("from", &PolishOptions::from, {0, 0.999}, "of the schedule",
           "Position in the schedule of the geometry stage at which polishing begins");
  add_joint(preset.part("joint.", &Preset::joint));
  add_meshing(preset.part("meshing.", &Preset::meshing));
  add_meshing(preset.part("finer_meshing.", &Preset::finer_meshing));
  return table;
}

}  // namespace

const SettingTable<Preset>& preset_settings() {
  static const SettingTable<Preset> table = make_table();
  return table;
}

bool is_fitted(const Preset& preset, const std::string& key) {
  static const std::vector<std::string> grids{"trial.geometry.sdf.", "geometry.sdf.", "appearance.albedo.",
                                              "appearance.materials."};
  if (key == "meshing.resolution" || key == "finer_meshing.resolution") return preset.resolution_from_views;
  for (const std::string& grid : grids)
    if (key == grid + "encoding.finest_resolution" || key == grid + "encoding.log2_table")
      return preset.resolution_from_views || grid.starts_with("trial");
  return false;
}

}  // namespace cei3d
