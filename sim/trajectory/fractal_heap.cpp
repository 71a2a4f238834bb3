#include "sim/trajectory/fractal_heap.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace sim::file {

namespace {

constexpr const char* index_of_attributes = "the index of its attributes";
constexpr std::uint64_t attribute_names = 8, huge_objects = 1;  // types of B-trees

void require(bool fits) {
  if (!fits) throw Refused(index_of_attributes);
}

/// Records of a B-tree of one leaf, as the attributes of any trajectory are, or of one node with leaves.
std::vector<std::string> records(Blocks& blocks, std::uint64_t address, std::uint64_t type,
                                 std::uint64_t record_bytes) {
  const std::string head = blocks.sealed(address, 34);
  Cursor c(head);
  require(c.bytes(4) == "BTHD" && c.number(1) == 0 && c.number(1) == type);
  const std::uint64_t node_bytes = c.number(4);
  require(c.number(2) == record_bytes);
  const std::uint64_t depth = c.number(2);
  if (depth > 1) throw Unread(index_of_attributes);
  c.skip(2);
  const std::uint64_t root = c.number(8), count = c.number(2);
  std::vector<std::string> all;
  if (count == 0) return all;
  /// The records of a node; what follows them is left.
  const auto take = [&](Cursor& node, std::string_view mark, std::uint64_t number) {
    require(node.bytes(4) == mark && node.number(1) == 0 && node.number(1) == type);
    for (std::uint64_t k = 0; k < number; ++k) all.emplace_back(node.bytes(record_bytes));
  };
  const auto leaf = [&](std::uint64_t at, std::uint64_t number) {
    const std::string bytes = blocks.sealed(at, 6 + number * record_bytes);
    Cursor node(bytes);
    take(node, "BTLF", number);
  };
  require(node_bytes > 10 + record_bytes);
  if (depth == 0) {
    leaf(root, count);
    return all;
  }
  const std::uint64_t in_a_leaf = (node_bytes - 10) / record_bytes,
                      count_bytes = static_cast<std::uint64_t>(std::bit_width(in_a_leaf) - 1) / 8 + 1;
  const std::string bytes = blocks.sealed(root, 6 + count * record_bytes + (count + 1) * (8 + count_bytes));
  Cursor node(bytes);
  take(node, "BTIN", count);
  for (std::uint64_t k = 0; k <= count; ++k) {
    const std::uint64_t at = node.number(8);
    leaf(at, node.number(count_bytes));
  }
  return all;
}

/// A fractal heap: small objects in blocks of a range of offsets, huge ones in the file itself.
struct Heap {
  struct Block {
    std::uint64_t offset = 0, address = 0, size = 0;
    std::string bytes = {};  ///< once they are needed
  };
  Blocks& blocks;
  std::uint64_t address = 0, id_bytes = 0, offset_bytes = 0, length_bytes = 0, huge_index = no_address;
  bool sealed = false;  ///< the blocks
  std::vector<Block> parts = {};
  std::vector<std::string> huge = {};

  Heap(Blocks& file, std::uint64_t at) : blocks(file), address(at) {
    const std::string head = blocks.sealed(at, 142);
    Cursor c(head);
    require(c.bytes(4) == "FRHP" && c.number(1) == 0);
    id_bytes = c.number(2);
    if (c.number(2) != 0) throw Unread(index_of_attributes);  // filters
    sealed = c.number(1) & 2;
    const std::uint64_t largest_object = c.number(4);
    c.skip(8);
    huge_index = c.number(8);
    c.skip(10 * 8);
    const std::uint64_t width = c.number(2), first = c.number(8), largest = c.number(8), bits = c.number(2);
    c.skip(2);
    const std::uint64_t root = c.number(8), rows = c.number(2);
    // As HDF5 makes them for attributes; others might take any memory.
    if (width != 4 || !std::has_single_bit(first) || largest != 65536 || first > largest || bits > 64 ||
        largest_object == 0 || largest_object >= largest)
      throw Unread(index_of_attributes);
    offset_bytes = (bits + 7) / 8;
    length_bytes = static_cast<std::uint64_t>(std::bit_width(largest_object) - 1) / 8 + 1;
    if (root == no_address) return;
    if (rows == 0) {
      parts.push_back({0, root, first});
      return;
    }
    if (first << (rows < 2 ? 0 : std::min<std::uint64_t>(rows - 2, 32)) > largest)
      throw Unread(index_of_attributes);  // indirect rows
    const std::string table = blocks.sealed(root, 13 + offset_bytes + rows * width * 8);
    Cursor t(table);
    require(t.bytes(4) == "FHIB" && t.number(1) == 0 && t.number(8) == address);
    t.skip(offset_bytes);
    std::uint64_t offset = 0;
    for (std::uint64_t row = 0; row < rows; ++row)
      for (std::uint64_t k = 0; k < width; ++k) {
        const std::uint64_t size = first << (row == 0 ? 0 : row - 1), child = t.number(8);
        if (child != no_address) parts.push_back({offset, child, size});
        offset += size;
      }
  }

  std::string object(std::string_view id) {
    Cursor c(id);
    const std::uint64_t kind = c.number(1);
    if (kind == 0x00) {
      const std::uint64_t offset = c.number(offset_bytes), length = c.number(length_bytes);
      return managed(offset, length);
    }
    if (kind != 0x10 || id_bytes > 9) throw Unread(index_of_attributes);
    const std::uint64_t key = c.number(id_bytes - 1);
    if (huge.empty()) huge = records(blocks, huge_index, huge_objects, 24);
    for (const std::string& record : huge) {
      Cursor r(record);
      const std::uint64_t at = r.number(8), size = r.number(8);
      if (r.number(8) == key) return blocks.at(at, size);
    }
    throw Refused(index_of_attributes);
  }

  std::string managed(std::uint64_t offset, std::uint64_t length) {
    for (Block& b : parts) {
      if (offset < b.offset || offset - b.offset >= b.size) continue;
      if (b.bytes.empty()) load(b);
      require(length <= b.size - (offset - b.offset));
      return b.bytes.substr(offset - b.offset, length);
    }
    throw Refused(index_of_attributes);
  }

  void load(Block& b) const {
    b.bytes = blocks.at(b.address, b.size);
    Cursor c(b.bytes);
    require(c.bytes(4) == "FHDB" && c.number(1) == 0 && c.number(8) == address && c.number(offset_bytes) == b.offset);
    if (sealed) {  // as if the checksum itself were zero
      const std::size_t at = b.bytes.size() - c.left();
      const std::uint64_t sum = c.number(4);
      std::memset(b.bytes.data() + at, 0, 4);
      require_checksum(b.bytes, sum);
    }
  }
};

}  // namespace

std::vector<std::string> dense_attributes(Blocks& blocks, std::uint64_t heap, std::uint64_t index) {
  Heap from(blocks, heap);
  std::vector<std::string> all;
  for (const std::string& record : records(blocks, index, attribute_names, from.id_bytes + 9)) {
    if (record[from.id_bytes] & 2) throw Unread(index_of_attributes);  // shared: in a heap of the whole file
    all.push_back(from.object(std::string_view(record).substr(0, from.id_bytes)));
  }
  return all;
}

}  // namespace sim::file
