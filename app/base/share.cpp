#include "app/base/share.h"

#include <charconv>
#include <cstdlib>
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

std::optional<Share> share_in(const char* index, const char* count, int first = 0) {
  const std::optional<int> i = number_in(index), n = number_in(count);
  if (!i || !n || *i < first || *i - first >= *n) return {};
  return Share{*i - first, *n};
}

}  // namespace

std::optional<Share> share_of_environment() {
  const std::optional<Share> task =
      share_in("SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", number_in("SLURM_ARRAY_TASK_MIN").value_or(0));
  std::optional<Share> rank = share_in("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE");
  if (!rank) rank = share_in("PMI_RANK", "PMI_SIZE");
  if (!rank) rank = share_in("SLURM_PROCID", "SLURM_NTASKS");
  if (!task || !rank) return task ? task : rank;
  return Share{task->index * rank->count + rank->index, task->count * rank->count};
}

}  // namespace app
