#include "sim/membrane/membrane.h"

namespace sim {

Membrane freeze_membrane(Plans& plans, const Material& material, const Coefficients& position, double upsampling,
                         int source_order, const Coefficients& expected_tension, std::optional<PinnedTension> pinned) {
  Sheet sheet = freeze_sheet(plans, material, position, upsampling, expected_tension, pinned);
  LayerMatrices layers =
      plans.layers(position.order, source_order).assemble(position, material.viscosity_contrast != 1);
  return {std::move(sheet), std::move(layers), surface_waves(plans, position)};
}

Vector packed(const Motion& m) {
  Vector y(m.velocity.values.size() + m.tension.values.size());
  y << m.velocity.values.reshaped(), m.tension.values.reshaped();
  y.tail(2 * m.tension.order + 1).setZero();  // a tension carried through a relabelling has a highest degree
  return y;
}

Motion unpacked(const Vector& y, int order) {
  const int nc = coefficient_count(order);
  return {{order, y.head(3 * nc).reshaped(nc, 3)}, {order, y.tail(nc)}};
}

Coefficients double_layer(const Membrane& m, const Coefficients& velocity) {
  Coefficients v{m.order(), {}};
  if (m.layers.dual.order < 0) return v;
  const Coefficients rigid = rigid_velocity(m.body, rigid_part(m.body, velocity));
  v.values = m.layers.dual.apply({velocity.order, velocity.values - rigid.values}).values - 0.5 * rigid.values;
  v.values *= 1 - m.material.viscosity_contrast;
  return v;
}

Coefficients dual_density(const RigidBody& body, double viscosity_contrast, const Coefficients& velocity) {
  if (viscosity_contrast == 1) return {velocity.order, Matrix::Zero(velocity.values.rows(), 3)};
  Coefficients d = without_rigid_part(body, velocity);
  d.values *= 1 - viscosity_contrast;
  return d;
}

Coefficients layer_velocity(const Membrane& m, const Coefficients& force, const Coefficients& velocity) {
  Coefficients v = m.layers.single.apply(force);
  if (m.layers.dual.order >= 0) v.values += double_layer(m, velocity).values;
  return v;
}

Vector system_rows(const Membrane& m, const Motion& y, const Coefficients& v) {
  Vector rows = packed({{m.order(), m.material.alpha() * y.velocity.values - v.values}, divergence(m, v)});
  const Eigen::Index nc = coefficient_count(m.order());
  rows.tail(nc) *= -m.radius;
  if (m.pinned) rows[rows.size() - nc] = y.tension.values(0, 0);
  return rows;
}

Vector system_right(const Membrane& m, const Coefficients& r) {
  Vector right = packed({r, divergence(m, r)});
  const Eigen::Index nc = coefficient_count(m.order());
  right.tail(nc) *= m.radius;
  if (m.pinned) right[right.size() - nc] = 0;
  return right;
}

Vector apply_system(const Membrane& m, double c, const Vector& unknowns) {
  const Motion y = unpacked(unknowns, m.order());
  return system_rows(m, y, layer_velocity(m, implicit_force(m, c, y), y.velocity));
}

}  // namespace sim
