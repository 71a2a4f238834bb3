#include "sim/trajectory/trajectory_datasets.h"

#include <algorithm>
#include <span>

namespace sim::file {

std::vector<Dataset> datasets(const TrajectoryLayout& layout, std::uint64_t scene_bytes) {
  const auto states = static_cast<std::uint64_t>(layout.states), steps = static_cast<std::uint64_t>(layout.steps);
  std::vector<Dataset> all{{"count", "number of saved states; rows from here on are unused", Kind::integer, {}},
                           {"steps/count", "number of step records", Kind::integer, {}},
                           {"notes_count", "number of notes", Kind::integer, {}},
                           {"resume_head",
                            "per slot: number of the writing, numbers used, crc32 of both and of these",
                            Kind::integer,
                            {2, 3}},
                           {"checksum", "2^32 + crc32 of row number and row", Kind::integer, {states}},
                           {"steps/checksum", "2^32 + crc32 of row number and row", Kind::integer, {steps}},
                           {"scene", "the resolved scene", Kind::text, {}, std::max<std::uint64_t>(scene_bytes, 1)},
                           {"notes", "remarks made during the run", Kind::text, {note_rows}, note_bytes}};
  const auto add = [&all](const std::vector<rows::Column>& columns, std::uint64_t count) {
    for (const rows::Column& column : columns) {
      Dataset d{column.name, column.meaning, column.integer ? Kind::integer : Kind::real, {count}};
      d.shape.insert(d.shape.end(), column.shape.begin(), column.shape.end());
      all.push_back(std::move(d));
    }
  };
  add(rows::step_columns(layout), steps);
  all.push_back({"resume",
                 "what the stepper needs to continue, two slots",
                 Kind::real,
                 {2, static_cast<std::uint64_t>(layout.resume)}});
  add(rows::state_columns(layout), states);
  return all;
}

std::uint64_t scene_checksum(const std::string& scene) {
  return rows::checksum(scene.size(), std::as_bytes(std::span(scene)));
}

}  // namespace sim::file
