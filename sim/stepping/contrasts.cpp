#include "sim/stepping/contrasts.h"

#include "sim/measures/statement.h"
#include "sim/surface/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace sim {

namespace {

constexpr double small = 1e-2;  ///< larger ones are above what any order that resolves its shape errs by
constexpr double told = 0.05, refused = 1;

struct Doubtful {
  std::size_t vesicle = 0, others = 0;
  double error = 0, contrast = 1;
  double share() const { return error / contrast; }
};

/// The worst of all vesicles whose order is given and whose quadrature errs by more than so much of their contrast; an
/// automatic order rises.
std::optional<Doubtful> worst(const Model& s, const Dynamics& d, double share) {
  std::optional<Doubtful> found;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    const double contrast = s.materials[k].viscosity_contrast;
    if (contrast >= small || order_follows(s.scene.time, s.scene.vesicles[k])) continue;
    const Doubtful one{k, found ? found->others + 1 : 0, quadrature_error(s.plans, d.vesicles[k].position), contrast};
    if (one.share() <= share) continue;
    if (!found || one.share() > found->share())
      found = one;
    else
      ++found->others;
  }
  return found;
}

/// What would do for a vesicle, in words.
std::string advice(const Model& s, const Dynamics& d, const Doubtful& one) {
  constexpr int highest = 32;  // beyond, one product takes seconds
  const int order = d.vesicles[one.vesicle].position.order;
  for (int higher = order + 2; higher <= highest; higher += 2) {
    VesicleParameters v = s.scene.vesicles[one.vesicle];
    v.order = higher;
    const Coefficients x = s.scene.start.from ? resized(d.vesicles[one.vesicle].position, higher) : initial_position(v);
    if (quadrature_error(s.plans, x) <= told * one.contrast) return fmt::format("vesicle.order = {} would do", higher);
  }
  return fmt::format("no order up to {} would do", highest);
}

std::string sentence(const Model& s, const Dynamics& d, const Doubtful& one, std::string_view judgement) {
  return fmt::format(
      "vesicle.viscosity_contrast = {:g} of vesicle {}{} {}: in order {} the double layer of a rigid motion errs by "
      "{:.1e}, {:.2g} times the contrast; {}, or a contrast of {:.1e}",
      one.contrast, one.vesicle, one.others > 0 ? fmt::format(" (and {} more)", one.others) : std::string(), judgement,
      d.vesicles[one.vesicle].position.order, one.error, one.share(), advice(s, d, one), one.error / told);
}

}  // namespace

void check_contrasts(const Model& s, const Dynamics& d) {
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    if (const double contrast = s.materials[k].viscosity_contrast;
        contrast * std::numeric_limits<double>::epsilon() > 1)
      throw std::invalid_argument(
          fmt::format("vesicle.viscosity_contrast = {:g} of vesicle {} is too large to compute with: above {:.1e} it "
                      "leaves no digits of what the outer fluid does; 1000 is near a rigid body",
                      contrast, k, 1 / std::numeric_limits<double>::epsilon()));
  if (const auto one = worst(s, d, refused))
    throw std::invalid_argument(sentence(s, d, *one, "is too small to compute with"));
}

std::string contrast_warning(const Model& s, const Dynamics& d) {
  const auto one = worst(s, d, told);
  return one ? sentence(s, d, *one, "is small for its order") : std::string();
}

}  // namespace sim
