#include "sim/measures/rheology.h"

#include "sim/membrane/cell.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace sim {

SuspensionMeasures suspension_measures(const Scene& scene, std::span<const VesicleMeasures> vesicles,
                                       std::span<const FlowMeasures> flow, std::span<const Vec3> first) {
  SuspensionMeasures m;
  const auto n = static_cast<double>(vesicles.size());
  if (vesicles.empty()) return m;
  constexpr double degree = std::numbers::pi / 180;
  std::complex<double> double_angle = 0;
  double volume = 0;
  Vec3 drift = Vec3::Zero(), squares = Vec3::Zero();
  for (std::size_t k = 0; k < vesicles.size(); ++k) {
    double_angle += std::polar(1.0, 2 * degree * vesicles[k].inclination_deg) / n;
    volume += vesicles[k].volume;
    drift += (vesicles[k].center - first[k]) / n;
  }
  for (std::size_t k = 0; k < vesicles.size(); ++k) squares += (vesicles[k].center - first[k] - drift).cwiseAbs2() / n;
  m.displacement = squares;
  m.inclination_mean = std::arg(double_angle) / (2 * degree);
  m.inclination_spread = std::sqrt(std::max(0.0, -2 * std::log(std::abs(double_angle)))) / (2 * degree);
  if (!scene.cell.size) return m;
  const double cell = cell_volume(scene);
  m.volume_fraction = volume / cell;
  const std::optional<double> rate = steady_shear_rate(scene.flows);
  if (!rate || flow.empty()) return m;
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  for (const FlowMeasures& f : flow) stress += f.stresslet / cell;
  m.relative_viscosity = 1 + stress(0, 2) / *rate;
  m.normal_stress_1 = (stress(0, 0) - stress(2, 2)) / std::abs(*rate);
  m.normal_stress_2 = (stress(2, 2) - stress(1, 1)) / std::abs(*rate);
  return m;
}

PairDistribution::PairDistribution(const Vec3& size, int bins)
    : reach_(size.minCoeff() / 2), volume_(size.prod()), counts_(static_cast<std::size_t>(bins), 0) {}

void PairDistribution::add(std::span<const Vec3> centres, const Eigen::Matrix3d& cell) {
  const Eigen::Matrix3d inverse = cell.inverse();
  for (std::size_t i = 0; i < centres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 away = inverse * (centres[i] - centres[j]), home = away - away.array().round().matrix();
      // The nearest image is one of these: a cell leans by no more than half of its length.
      for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b)
          for (int c = -1; c <= 1; ++c)
            if (const double r = (cell * (home + Vec3(a, b, c))).norm(); r < reach_)
              counts_[static_cast<std::size_t>(r / reach_ * static_cast<double>(counts_.size()))] += 1;
    }
  const auto n = static_cast<double>(centres.size());
  expected_ += n * (n - 1) / 2 / volume_;
}

std::vector<PairDistribution::Row> PairDistribution::rows() const {
  std::vector<Row> all;
  const double width = reach_ / static_cast<double>(counts_.size());
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const double from = width * static_cast<double>(k), to = from + width;
    const double shell = 4 * std::numbers::pi / 3 * (std::pow(to, 3) - std::pow(from, 3));
    all.push_back({from, to, counts_[k] / (shell * expected_)});
  }
  return all;
}

MeanPairs mean_pairs(const Vec3& size, int bins, std::span<const CentresInCell> states, int blocks) {
  const auto over = [&](std::size_t first, std::size_t end) {
    PairDistribution pairs(size, bins);
    for (std::size_t k = first; k < end; ++k) pairs.add(states[k].centres, states[k].cell);
    return pairs.rows();
  };
  MeanPairs mean{over(0, states.size()), {}};
  const std::size_t parts = std::min(static_cast<std::size_t>(blocks), states.size());
  if (parts < 2) return mean;
  std::vector<double> sum(mean.rows.size(), 0), squares = sum;
  for (std::size_t b = 0; b < parts; ++b) {
    const auto rows = over(b * states.size() / parts, (b + 1) * states.size() / parts);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double away = rows[k].share - mean.rows[k].share;  // small, so that the squares do not cancel
      sum[k] += away;
      squares[k] += away * away;
    }
  }
  const auto n = static_cast<double>(parts);
  for (std::size_t k = 0; k < sum.size(); ++k)
    mean.error.push_back(std::sqrt(std::max(0.0, squares[k] - sum[k] * sum[k] / n) / (n - 1) / n));
  return mean;
}

}  // namespace sim
