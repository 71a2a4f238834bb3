// The tables and figures of the paper, one function each.
#pragma once

#include "app/base/interrupt.h"
#include "app/base/options.h"
#include "app/base/progress.h"
#include "app/base/result_files.h"
#include "app/reproduce/reproduce_report.h"

#include "sim/core/parameters.h"

namespace app {

/// Requested effort.
struct Effort {
  bool quick = false;  ///< small orders and short times: a smoke test
  bool full = false;   ///< also the orders that take hours
  const Options& options;
  ResultFiles& files;  ///< the files it writes, except trajectories
  Progress& progress;
};

Report reproduce_upsampling(const Effort&);     // Table 2
Report reproduce_double_layer(const Effort&);   // Table 3
Report reproduce_stable_steps(const Effort&);   // Table 4
Report reproduce_cost(const Effort&);           // Table 5
Report reproduce_aliasing(const Effort&);       // Figure 2
Report reproduce_spectra(const Effort&);        // Figure 3
Report reproduce_poiseuille(const Effort&);     // Figure 4
Report reproduce_block_error(const Effort&);    // Figure 5
Report reproduce_two_vesicles(const Effort&);   // Figure 6
Report reproduce_tank_treading(const Effort&);  // other authors' angles and frequencies

/// Orders p of tables 4 and 5.
std::vector<int> table_orders(const Effort&);
inline constexpr double paper_step = 0.21;  ///< time step of the paper's runs in shear, times the shear rate

/// The four shapes of tables 2 and 3; the paper's are only pictured.
struct NamedShape {
  std::string name;
  sim::VesicleParameters parameters;  ///< at any order
};
const std::vector<NamedShape>& reference_shapes();

/// One prolate of reduced volume 0.85 and area 4 pi along x in the shear flow u = z e_x, kappa_b = 0.01.
sim::Scene sheared_prolate(int order, double viscosity_contrast);
/// Its description in the reports.
extern const char* const prolate_setting;
/// Two of them with centres -+(1.2, 0, -0.5): scenes/two-vesicles.toml.
sim::Scene sheared_pair(int order, double viscosity_contrast);

/// The physics and pictures of figures 4 and 6, as scene files: scenes/parachute.toml at the paper's steps, and
/// scenes/two-vesicles.toml.
extern const char* const poiseuille_scene;
extern const char* const two_vesicles_scene;

}  // namespace app
