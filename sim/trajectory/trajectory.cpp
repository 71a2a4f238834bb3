#include "sim/trajectory/trajectory.h"

#include "sim/trajectory/trajectory_datasets.h"
#include "sim/trajectory/trajectory_file.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace sim {

namespace {

/// States that come further apart than this are synced to the disk, which takes some 0.4 ms each.
constexpr std::chrono::milliseconds unsynced_interval{50};

std::uint64_t bits(std::int64_t n) { return static_cast<std::uint64_t>(n); }

/// Number of the last resume record of a run that ends after so many steps; odd. A step renews the record at most once,
/// so that this number and the one before it are above all earlier ones.
std::uint64_t last_sequence(std::int64_t step) { return 4 * (bits(step) + 1) + 1; }

/// An open file and what HDF5 said about it: the half that reader and writer share.
struct OpenFile {
  std::filesystem::path path;
  file::Descriptor descriptor;
  file::Map map;
  std::vector<file::Place> state_places, step_places;

  OpenFile(const std::filesystem::path& p, bool writable) : path(p), descriptor(p, writable) {
    std::optional<file::Map> found = file::map(descriptor);
    for (int tries = 0; !found; ++tries) {  // a file that grew has just taken the name
      if (tries == 100) throw std::runtime_error(fmt::format("'{}' does not stay the same file", p.string()));
      descriptor = file::Descriptor(p, writable);
      found = file::map(descriptor);
    }
    map = std::move(*found);
    for (const rows::Column& c : rows::state_columns(map.layout)) state_places.push_back(map.at(c.name));
    for (const rows::Column& c : rows::step_columns(map.layout)) step_places.push_back(map.at(c.name));
  }

  void renamed(const std::filesystem::path& now) {
    path = now;
    descriptor.renamed(now);
  }

  std::uint64_t word(std::string_view dataset, std::uint64_t row = 0) const {
    std::uint64_t value = 0;
    descriptor.read(map.at(dataset).offset + 8 * row, &value, 8);
    return value;
  }
  void set_word(std::string_view dataset, std::uint64_t value, std::uint64_t row = 0) const {
    descriptor.write(map.at(dataset).offset + 8 * row, &value, 8);
  }

  rows::Words read_row(const std::vector<file::Place>& places, std::uint64_t row) const {
    std::size_t size = 0;
    for (const file::Place& p : places) size += p.row_bytes / 8;
    rows::Words words(size);
    std::size_t next = 0;
    for (const file::Place& p : places) {
      descriptor.read(p.offset + row * p.row_bytes, words.data() + next, p.row_bytes);
      next += p.row_bytes / 8;
    }
    return words;
  }
  /// The row, then its checksum.
  void write_row(const std::vector<file::Place>& places, std::string_view checksums, std::uint64_t row,
                 const rows::Words& words) const {
    std::size_t next = 0;
    for (const file::Place& p : places) {
      descriptor.write(p.offset + row * p.row_bytes, words.data() + next, p.row_bytes);
      next += p.row_bytes / 8;
    }
    set_word(checksums, rows::checksum(row, std::as_bytes(std::span(words))), row);
  }
  bool intact(std::string_view checksums, std::uint64_t row, const rows::Words& words) const {
    return word(checksums, row) == rows::checksum(row, std::as_bytes(std::span(words)));
  }

  /// Rows that are committed. The counter is the truth unless it is damaged; then the rows with a checksum are.
  std::int64_t committed(std::string_view counter, std::string_view checksums) const {
    const std::uint64_t count = word(counter), rows = map.at(checksums).rows;
    const auto written = [&](std::uint64_t row) { return word(checksums, row) >> 32 == 1; };
    // One row more than counted may be complete: a writer was stopped just before it counted it.
    const bool plausible =
        count <= rows && (count == 0 || written(count - 1)) && (count + 1 >= rows || !written(count + 1));
    if (plausible) return static_cast<std::int64_t>(count);
    std::uint64_t prefix = 0;
    while (prefix < rows && written(prefix)) ++prefix;
    return static_cast<std::int64_t>(prefix);
  }

  [[noreturn]] void damaged(const char* what, std::int64_t k, std::string_view why) const {
    throw std::runtime_error(fmt::format("{} {} of trajectory '{}' is damaged ({})", what, k, path.string(), why));
  }

  /// Where checksums fit, somebody may still have put them there: the numbers must be those of a state.
  State state(std::int64_t k) const {
    const rows::Words words = read_row(state_places, bits(k));
    if (!intact("checksum", bits(k), words)) damaged("state", k, "its checksum does not fit");
    try {
      return rows::unpack_state(words, map.layout);
    } catch (const rows::Unfit& unfit) {
      damaged("state", k, unfit.what());
    }
  }
  StepRecord step(std::int64_t k) const {
    const rows::Words words = read_row(step_places, bits(k));
    if (!intact("steps/checksum", bits(k), words)) damaged("step record", k, "its checksum does not fit");
    StepRecord record = rows::unpack_step(words, map.layout);
    if (record.step != static_cast<double>(k + 1) || !std::isfinite(record.time) || !std::isfinite(record.dt))
      damaged("step record", k, "its number or time is impossible");
    return record;
  }
  bool intact_state(std::int64_t k) const { return intact("checksum", bits(k), read_row(state_places, bits(k))); }
  /// Whole states come one after the other in time; a damaged one is told when it is read.
  void check_order(std::int64_t first, std::int64_t count) const {
    first = std::max<std::int64_t>(first, 1);
    if (first >= count) return;
    std::vector<double> times(static_cast<std::size_t>(count - first + 1));
    descriptor.read(map.at("time").offset + 8 * bits(first - 1), times.data(), 8 * times.size());
    for (std::int64_t k = first; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k - first + 1);
      if (!(times[i] > times[i - 1]) && intact_state(k - 1) && intact_state(k))
        damaged("state", k, "its time is not later");
    }
  }

  struct Slot {
    std::uint64_t sequence = 0;
    std::vector<double> payload;
  };
  static std::uint64_t slot_checksum(const Slot& slot) {
    return rows::checksum(slot.sequence, std::as_bytes(std::span(slot.payload)));
  }
  /// Slot 0 or 1; sequence 0: it is not intact.
  Slot slot(std::uint64_t s) const {
    const file::Place& place = map.at("resume");
    Slot slot{word("resume_head", 3 * s), {}};
    const std::uint64_t size = word("resume_head", 3 * s + 1);
    if (slot.sequence % 2 != s || size > place.row_bytes / 8) return {};
    slot.payload.resize(size);
    descriptor.read(place.offset + s * place.row_bytes, slot.payload.data(), 8 * size);
    return word("resume_head", 3 * s + 2) == slot_checksum(slot) ? slot : Slot{};
  }
  /// The newer of the two.
  Slot newest_slot() const {
    Slot even = slot(0), odd = slot(1);
    return even.sequence > odd.sequence ? even : odd;
  }
  void write_slot(const Slot& slot) const {
    const file::Place& place = map.at("resume");
    const std::uint64_t s = slot.sequence % 2;
    descriptor.write(place.offset + s * place.row_bytes, slot.payload.data(), 8 * slot.payload.size());
    const std::uint64_t head[3] = {slot.sequence, slot.payload.size(), slot_checksum(slot)};
    descriptor.write(map.at("resume_head").offset + 24 * s, head, sizeof head);
  }
  /// Zeros behind a payload: earlier ones may have been longer, and when they were written is a matter of the clock.
  void clear_behind(const Slot& slot) const {
    const file::Place& place = map.at("resume");
    const std::vector<double> zeros(place.row_bytes / 8 - slot.payload.size(), 0.0);
    descriptor.write(place.offset + (slot.sequence % 2) * place.row_bytes + 8 * slot.payload.size(), zeros.data(),
                     8 * zeros.size());
  }

  std::vector<std::string> notes() const {
    const std::uint64_t count = std::min(word("notes_count"), file::note_rows);
    std::vector<std::string> all;
    for (std::uint64_t k = 0; k < count; ++k) {
      char text[file::note_bytes + 1] = {};
      descriptor.read(map.at("notes").offset + k * file::note_bytes, text, file::note_bytes);
      all.emplace_back(text);
    }
    return all;
  }
};

}  // namespace

bool holds_trajectory(const std::filesystem::path& path) { return file::holds_mark(path); }

struct TrajectoryWriter::Impl {
  std::optional<file::Lock> lock;  ///< none before the file has its name: then its draft is locked
  OpenFile file;
  std::int64_t states = 0, steps = 0;                           ///< committed
  double last_time = -std::numeric_limits<double>::infinity();  ///< of the last state
  double last_step = 0;                                         ///< of the last record
  bool settled = true;                                          ///< the counters in the file are these
  std::uint64_t sequence = 0;                                   ///< of the last resume payload
  std::chrono::steady_clock::time_point last_append = std::chrono::steady_clock::now();

  explicit Impl(OpenFile f) : file(std::move(f)) {}

  /// A new file with room for at least so much; used rows are copied, then it takes the old one's name.
  void grow(std::int64_t state_rows, std::int64_t step_rows, std::int64_t resume_numbers) {
    TrajectoryLayout room = file.map.layout;
    room.states = std::max(room.states, state_rows);
    room.steps = std::max(room.steps, step_rows);
    room.resume = std::max(room.resume, resume_numbers);
    rewrite(file.map.header, room);
  }
  void rewrite(const TrajectoryHeader& header, const TrajectoryLayout& room) {
    const TrajectoryLayout former = file.map.layout;
    TrajectoryLayout layout = former;
    layout.states = std::max(layout.states, room.states);
    layout.steps = std::max(layout.steps, room.steps);
    layout.resume = std::max(layout.resume, room.resume);
    layout.order = std::max(layout.order, room.order);
    layout.label_order = std::max(layout.label_order, room.label_order);
    const std::filesystem::path path = file.path;
    Draft draft = file::draft(path);
    file::create(draft, path, layout, header);
    OpenFile larger(draft.path(), true);
    larger.renamed(path);
    std::vector<char> buffer(std::size_t{1} << 20);
    const auto copy = [&](std::string_view name, std::uint64_t rows) {
      const file::Place &from = file.map.at(name), &to = larger.map.at(name);
      for (std::uint64_t done = 0, size = rows * from.row_bytes; done < size;) {
        const std::uint64_t part = std::min<std::uint64_t>(buffer.size(), size - done);
        file.descriptor.read(from.offset + done, buffer.data(), part);
        larger.descriptor.write(to.offset + done, buffer.data(), part);
        done += part;
      }
    };
    if (layout.order == former.order && layout.label_order == former.label_order) {
      for (const rows::Column& c : rows::state_columns(layout)) copy(c.name, bits(states));
      copy("checksum", bits(states));
    } else {
      for (std::int64_t k = 0; k < states; ++k)  // a damaged one has no checksum afterwards
        if (file.intact_state(k))
          larger.write_row(larger.state_places, "checksum", bits(k), rows::pack(file.state(k), layout));
    }
    for (const rows::Column& c : rows::step_columns(layout)) copy(c.name, bits(steps));
    copy("steps/checksum", bits(steps));
    copy("notes", file::note_rows);
    for (const char* counter : {"count", "steps/count", "notes_count"}) copy(counter, 1);
    if (const OpenFile::Slot slot = file.newest_slot(); slot.sequence > 0) larger.write_slot(slot);
    file::publish(draft, path, false);
    file = std::move(larger);
    lock.emplace(std::move(draft));
  }

  void append_steps(std::span<const StepRecord> records) {
    settle_counters();
    const std::int64_t before = steps;
    for (const StepRecord& record : records) {
      if (steps > 0 && record.step <= last_step) continue;
      if (steps == file.map.layout.steps) {
        file.set_word("steps/count", bits(steps));
        grow(0, 2 * steps, 0);
      }
      file.write_row(file.step_places, "steps/checksum", bits(steps), rows::pack(record, file.map.layout));
      last_step = record.step;
      ++steps;
    }
    if (steps != before) file.set_word("steps/count", bits(steps));
  }

  /// A writer may have been stopped between rows and their counter; rows that are there are not written again.
  void settle_counters() {
    if (settled) return;
    settled = true;
    for (const auto& [counter, rows] : {std::pair{"count", states}, {"steps/count", steps}})
      if (file.word(counter) != bits(rows)) file.set_word(counter, bits(rows));
  }

  void append(const State& state) {
    settle_counters();
    if (state.time <= last_time) return;
    if (states == file.map.layout.states) grow(2 * states, 0, 0);
    const auto now = std::chrono::steady_clock::now();
    const bool sync = now - last_append > unsynced_interval;
    file.write_row(file.state_places, "checksum", bits(states), rows::pack(state, file.map.layout));
    if (sync) file.descriptor.sync(true);
    file.set_word("count", bits(states + 1));
    if (sync) file.descriptor.sync(true);
    ++states;
    last_time = state.time;
    last_append = now;
  }

  void write_resume(std::span<const double> payload) {
    const auto size = static_cast<std::int64_t>(payload.size());
    if (size > file.map.layout.resume) grow(0, 0, size + size / 4);
    file.write_slot({sequence + 1, {payload.begin(), payload.end()}});
    ++sequence;
  }

  void finish_resume(std::span<const double> payload, std::int64_t step) {
    // The slot that is newest stays until the other one is whole.
    const std::uint64_t first = last_sequence(step) - 1, newest = file.newest_slot().sequence;
    for (const std::uint64_t number : {first + (newest + 1) % 2, first + newest % 2}) {
      sequence = number - 1;
      write_resume(payload);
      file.clear_behind({number, {payload.begin(), payload.end()}});
    }
    sequence = first + 1;
  }
};

TrajectoryWriter::TrajectoryWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TrajectoryWriter::TrajectoryWriter(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter& TrajectoryWriter::operator=(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter::~TrajectoryWriter() = default;

TrajectoryWriter TrajectoryWriter::create(const std::filesystem::path& name, const TrajectoryLayout& layout,
                                          const TrajectoryHeader& header, const State& first,
                                          std::span<const double> resume_payload, const std::function<void()>& ready) {
  TrajectoryLayout room = layout;
  room.states = std::max<std::int64_t>(room.states, 1);
  room.steps = std::max<std::int64_t>(room.steps, 1);
  room.resume = std::max<std::int64_t>({room.resume, static_cast<std::int64_t>(resume_payload.size()), 1});
  const std::filesystem::path path = destination(name);
  // Whoever writes what is there now is not disturbed; nobody else begins while this one is put in its place.
  std::optional<file::Lock> former;
  if (std::filesystem::exists(path)) {
    file::require_ours(path);
    former.emplace(path);
  }
  Draft draft = file::draft(path);
  file::create(draft, path, room, header);
  auto impl = std::make_unique<Impl>(OpenFile(draft.path(), true));
  impl->file.renamed(path);  // it will be
  impl->append(first);
  impl->write_resume(resume_payload);
  if (ready) ready();
  file::publish(draft, path, !former);
  impl->lock.emplace(std::move(draft));
  return TrajectoryWriter(std::move(impl));
}

TrajectoryWriter TrajectoryWriter::resume(const std::filesystem::path& name) {
  const std::filesystem::path path = destination(name);
  if (!std::filesystem::exists(path))
    throw std::runtime_error(fmt::format("cannot resume '{}': no such file", path.string()));
  file::Lock lock(path);
  remove_dead_drafts(path.parent_path());  // of a growth that was killed
  auto impl = std::make_unique<Impl>(OpenFile(path, true));
  impl->lock.emplace(std::move(lock));
  impl->states = impl->file.committed("count", "checksum");
  impl->steps = impl->file.committed("steps/count", "steps/checksum");
  impl->settled = false;
  if (impl->states == 0) throw std::runtime_error(fmt::format("trajectory '{}' has no intact state", path.string()));
  const State last = impl->file.state(impl->states - 1);
  impl->last_time = last.time;
  if (impl->steps > 0) impl->last_step = impl->file.step(impl->steps - 1).step;
  impl->sequence = impl->file.newest_slot().sequence;
  if (impl->sequence == 0)
    throw std::runtime_error(
        fmt::format("trajectory '{}' cannot be resumed: both resume records are damaged", path.string()));
  return TrajectoryWriter(std::move(impl));
}

bool TrajectoryWriter::holds(std::int64_t step, double time, std::int64_t saves) const {
  const Impl& w = *impl_;
  if (step < 0 || step > w.steps || saves < 1 || saves > w.states) return false;
  if (step == 0 ? time != 0 : w.file.step(step - 1).time != time) return false;
  const auto step_of = [&](std::int64_t state) { return static_cast<std::int64_t>(w.file.word("step", bits(state))); };
  return step_of(saves - 1) <= step && (saves == w.states || step_of(saves) > step);
}

void TrajectoryWriter::continue_as(std::string_view scene, const TrajectoryLayout& room) {
  TrajectoryHeader header = impl_->file.map.header;
  header.scene = scene;
  impl_->rewrite(header, room);
}

void TrajectoryWriter::make_room(const TrajectoryLayout& room) {
  const TrajectoryLayout& now = impl_->file.map.layout;
  if (room.order <= now.order && room.label_order <= now.label_order) return;
  impl_->settle_counters();
  impl_->rewrite(impl_->file.map.header, room);
}

const TrajectoryHeader& TrajectoryWriter::header() const { return impl_->file.map.header; }
const TrajectoryLayout& TrajectoryWriter::layout() const { return impl_->file.map.layout; }
std::int64_t TrajectoryWriter::count() const { return impl_->states; }
double TrajectoryWriter::last_time() const { return impl_->last_time; }
std::vector<double> TrajectoryWriter::resume_payload() const { return impl_->file.newest_slot().payload; }

void TrajectoryWriter::append(const State& state, std::span<const StepRecord> records) {
  impl_->append_steps(records);
  impl_->append(state);
}
void TrajectoryWriter::append_steps(std::span<const StepRecord> records) { impl_->append_steps(records); }
void TrajectoryWriter::write_resume(std::span<const double> payload) { impl_->write_resume(payload); }
void TrajectoryWriter::finish_resume(std::span<const double> payload, std::int64_t step) {
  impl_->finish_resume(payload, step);
}

void TrajectoryWriter::note(std::string_view text) {
  const std::string cut(text.substr(0, file::note_bytes - 1));
  const std::vector<std::string> notes = impl_->file.notes();
  if (notes.size() == file::note_rows || std::find(notes.begin(), notes.end(), cut) != notes.end()) return;
  char row[file::note_bytes] = {};
  cut.copy(row, cut.size());
  impl_->file.descriptor.write(impl_->file.map.at("notes").offset + notes.size() * file::note_bytes, row, sizeof row);
  impl_->file.set_word("notes_count", notes.size() + 1);
}

struct TrajectoryReader::Impl {
  OpenFile file;
  std::int64_t states = 0;

  explicit Impl(const std::filesystem::path& path) : file(path, false) { look(); }
  void look() {
    const std::int64_t before = states;
    states = file.committed("count", "checksum");
    file.check_order(before, states);
  }
  void check(std::int64_t k) const {
    if (k < 0 || k >= states)
      throw std::runtime_error(
          fmt::format("trajectory '{}' has states 0 to {}, not {}", file.path.string(), states - 1, k));
  }
};

TrajectoryReader::TrajectoryReader(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
TrajectoryReader::TrajectoryReader(TrajectoryReader&&) noexcept = default;
TrajectoryReader& TrajectoryReader::operator=(TrajectoryReader&&) noexcept = default;
TrajectoryReader::~TrajectoryReader() = default;

const TrajectoryHeader& TrajectoryReader::header() const { return impl_->file.map.header; }
const TrajectoryLayout& TrajectoryReader::layout() const { return impl_->file.map.layout; }
std::int64_t TrajectoryReader::count() const { return impl_->states; }

std::int64_t TrajectoryReader::refresh() {
  const std::filesystem::path path = impl_->file.path;
  // A file that grew has been replaced by a larger one.
  if (file::Descriptor(path, false).inode() != impl_->file.descriptor.inode())
    *impl_ = Impl(path);
  else
    impl_->look();
  return impl_->states;
}

State TrajectoryReader::state(std::int64_t k) const {
  impl_->check(k);
  return impl_->file.state(k);
}

double TrajectoryReader::time(std::int64_t k) const {
  impl_->check(k);
  const double time = std::bit_cast<double>(impl_->file.word("time", bits(k)));
  if (!std::isfinite(time) || time < 0) impl_->file.damaged("state", k, "its time is impossible");
  return time;
}

std::vector<StepRecord> TrajectoryReader::steps() const {
  std::vector<StepRecord> records;
  const std::int64_t count = impl_->file.committed("steps/count", "steps/checksum");
  for (std::int64_t k = 0; k < count; ++k) records.push_back(impl_->file.step(k));
  return records;
}

std::vector<std::string> TrajectoryReader::notes() const { return impl_->file.notes(); }
std::vector<double> TrajectoryReader::resume_payload() const { return impl_->file.newest_slot().payload; }

bool TrajectoryReader::finished_after(std::int64_t step) const {
  const OpenFile& file = impl_->file;
  return file.slot(0).sequence == last_sequence(step) - 1 && file.slot(1).sequence == last_sequence(step);
}

std::vector<std::int64_t> TrajectoryReader::damaged() const {
  std::vector<std::int64_t> rows;
  for (std::int64_t k = 0; k < impl_->states; ++k)
    if (!impl_->file.intact_state(k)) rows.push_back(k);
  return rows;
}

}  // namespace sim
