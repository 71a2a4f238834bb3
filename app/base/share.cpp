#include "app/base/share.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace app {

namespace {

std::optional<int> number_in(const char* variable) {
  const char* text = std::getenv(variable);
  if (!text) return {};
  const std::string_view word(text);
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

std::optional<Share> share_in(const char* index, const char* count) {
  const std::optional<int> i = number_in(index), n = number_in(count);
  if (!i || !n || *i < 0 || *i >= *n) return {};
  return Share{*i, *n};
}

std::optional<Share> task_of_array() {
  const std::optional<int> id = number_in("SLURM_ARRAY_TASK_ID"), count = number_in("SLURM_ARRAY_TASK_COUNT");
  if (!id || !count) return {};
  const int first = number_in("SLURM_ARRAY_TASK_MIN").value_or(0);
  const int step = std::max(1, number_in("SLURM_ARRAY_TASK_STEP").value_or(1));
  const long long last = number_in("SLURM_ARRAY_TASK_MAX").value_or(first + step * (*count - 1));
  const long long offset = static_cast<long long>(*id) - first;
  const bool even = last - first == static_cast<long long>(step) * (*count - 1) && offset % step == 0;
  if (!even || offset < 0 || offset / step >= *count)
    throw std::runtime_error("the numbers of this Slurm array are not evenly spaced, so they tell no shares; give i/n");
  return Share{static_cast<int>(offset / step), *count};
}

}  // namespace

Share share_of_environment() {
  const std::optional<Share> task = task_of_array();
  std::optional<Share> rank = share_in("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE");
  if (!rank) rank = share_in("PMI_RANK", "PMI_SIZE");
  // A batch script has SLURM_PROCID without srun, too, but no tasks of a step.
  if (!rank) rank = share_in("SLURM_PROCID", "SLURM_STEP_NUM_TASKS");
  if (!task && !rank)
    throw std::runtime_error("there is neither a rank of MPI nor a task of a Slurm array here; give i/n");
  if (!task || !rank) return task ? *task : *rank;
  constexpr int most = 1'000'000;
  if (static_cast<long long>(task->count) * rank->count > most)
    throw std::runtime_error(fmt::format("tasks and ranks make more than {} shares; give i/n", most));
  return Share{task->index * rank->count + rank->index, task->count * rank->count};
}

}  // namespace app
