#include "sim/trajectory/attributes.h"

#include "sim/trajectory/fractal_heap.h"

#include <cstring>

namespace sim::file {

namespace {

constexpr std::uint64_t message_attribute = 0x0c, message_continuation = 0x10, message_attribute_info = 0x15;
constexpr std::uint64_t largest_chunk = 16 << 20;

/// A message of an object header.
struct Message {
  std::uint64_t type = 0;
  bool shared = false;  ///< elsewhere: its bytes only say where
  std::string bytes;
};

/// The messages of one chunk of a header of version 1, aligned to 8 bytes, or 2.
struct Chunk {
  std::string bytes;
  bool aligned = false, ordered = false;

  void append_to(std::vector<Message>& all) const {
    const std::size_t head = aligned ? 8 : ordered ? 6 : 4;
    for (Cursor c(bytes); c.left() >= head;) {
      Message m;
      m.type = c.number(aligned ? 2 : 1);
      const std::uint64_t size = c.number(2);
      m.shared = c.number(1) & 2;
      c.skip(aligned ? 3 : ordered ? 2 : 0);
      m.bytes = c.bytes(size);
      all.push_back(std::move(m));
    }
  }
};

/// Address of the root's object header.
std::uint64_t root_address(Blocks& blocks) {
  const std::uint64_t version = Cursor(blocks.at(8, 1)).number(1);
  if (version > 3) throw Unread("its superblock");
  const bool old = version < 2;
  const std::string sizes = blocks.at(old ? 13 : 9, 2);
  if (sizes != "\x8\x8") throw Unread("its superblock");
  const std::uint64_t at = version == 0 ? 24 : version == 1 ? 28 : 12, root = old ? at + 40 : at + 24;
  if (Cursor(blocks.at(at, 8)).number(8) != 0) throw Unread("its superblock");
  return Cursor(blocks.at(root, 8)).number(8);
}

std::vector<Message> messages(Blocks& blocks, std::uint64_t address) {
  const std::string start = blocks.at(address, 6);
  std::vector<Message> all;
  Chunk chunk;
  if (start.starts_with("OHDR")) {
    Cursor c(start);
    c.skip(4);
    if (c.number(1) != 2) throw Unread("its object header");
    const std::uint64_t flags = c.number(1), width = std::uint64_t{1} << (flags & 3),
                        before = 6 + (flags & 0x20 ? 16 : 0) + (flags & 0x10 ? 4 : 0),
                        size = Cursor(blocks.at(address + before, width)).number(width);
    if (size > largest_chunk) throw Refused("its object header");
    chunk.bytes = blocks.sealed(address, before + width + size).substr(before + width);
    chunk.ordered = flags & 4;
  } else {
    Cursor c(start);
    if (c.number(1) != 1) throw Refused("its object header");
    chunk.bytes = blocks.at(address + 16, Cursor(blocks.at(address + 8, 4)).number(4));
    chunk.aligned = true;
  }
  chunk.append_to(all);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].type != message_continuation) continue;
    Cursor c(all[k].bytes);
    const std::uint64_t at = c.number(8), size = c.number(8);
    if (chunk.aligned) {
      chunk.bytes = blocks.at(at, size);
    } else {
      if (size < 8) throw Refused("its object header");
      chunk.bytes = blocks.sealed(at, size - 4);
      if (!chunk.bytes.starts_with("OCHK")) throw Refused("its object header");
      chunk.bytes.erase(0, 4);
    }
    chunk.append_to(all);
  }
  return all;
}

/// A type as the file describes it, whatever the version of the description.
bool is_number(std::string_view type) {
  using namespace std::string_view_literals;
  return type.size() >= 12 && (type[0] & 0x0f) == 0 && type.substr(1, 11) == "\x8\0\0\x8\0\0\0\0\0\x40\0"sv;
}
bool is_fixed_text(std::string_view type) { return type.size() >= 8 && (type[0] & 0x0f) == 3; }
bool is_scalar(std::string_view space) {
  return space.size() >= 4 && space[1] == 0 && (space[0] == 1 || (space[0] == 2 && space[3] == 0));
}

}  // namespace

Attributes::Attributes(const Descriptor& file) {
  Blocks blocks(file);
  for (const Message& m : messages(blocks, root_address(blocks))) {
    if (m.type != message_attribute && m.type != message_attribute_info) continue;
    if (m.shared) throw Unread("an attribute");
    if (m.type == message_attribute) {
      add(m.bytes);
      continue;
    }
    Cursor c(m.bytes);
    if (c.number(1) != 0) throw Unread("the index of its attributes");
    c.skip(c.number(1) & 1 ? 2 : 0);
    const std::uint64_t heap = c.number(8), index = c.number(8);
    if (heap == no_address) continue;
    dense_ = true;
    for (const std::string& object : dense_attributes(blocks, heap, index)) add(object);
  }
}

void Attributes::add(std::string_view message) {
  Cursor c(message);
  const std::uint64_t version = c.number(1), flags = c.number(1), name_bytes = c.number(2), type_bytes = c.number(2),
                      space_bytes = c.number(2);
  if (version < 1 || version > 3) throw Refused("an attribute");
  if (version == 3) c.skip(1);  // the letters of the name
  const auto part = [&](std::uint64_t size) {
    const std::string_view bytes = c.bytes(size);
    if (version == 1) c.skip((8 - size % 8) % 8);
    return bytes;
  };
  std::string_view name = part(name_bytes);
  if (name.empty() || name.find('\0') != name.size() - 1) throw Refused("an attribute");
  name.remove_suffix(1);
  const std::string_view type = part(type_bytes), space = part(space_bytes);
  Attribute attribute;
  // Shared types and extents lie elsewhere; this program has none.
  if ((version == 1 || flags == 0) && is_scalar(space) && (is_number(type) || is_fixed_text(type))) {
    const std::uint64_t size = Cursor(type.substr(4)).number(4);
    if (size <= c.left()) attribute = {is_number(type) ? Kind::number : Kind::text, std::string(c.bytes(size))};
  }
  all_.emplace(name, std::move(attribute));
}

std::string_view Attributes::bytes_of(const char* name, Kind kind) const {
  const auto found = all_.find(name);
  if (found == all_.end() || found->second.kind != kind) throw Refused(name);
  return found->second.bytes;
}

std::string Attributes::text(const char* name) const {
  const std::string_view bytes = bytes_of(name, Kind::text);
  if (bytes.empty()) throw Refused(name);
  return std::string(bytes.substr(0, bytes.find('\0')));
}

std::int64_t Attributes::number(const char* name) const {
  std::int64_t value = 0;
  std::memcpy(&value, bytes_of(name, Kind::number).data(), sizeof value);
  return value;
}

}  // namespace sim::file
