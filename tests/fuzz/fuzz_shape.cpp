// Text tables of shapes. What is accepted is a surface of finite numbers.
#include "sim/surface/shapes.h"
#include "support.h"

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  sim::VesicleParameters v;
  v.shape = "file";
  v.file = file.path().string();
  v.order = 4;
  fuzz::accepted([&] {
    const sim::Coefficients x = sim::initial_position(v);
    if (x.order != 4 || !x.values.allFinite()) fuzz::broken("an accepted shape is finite");
  });
  return 0;
}
