// What may not succeed: a value, or the reason why there is none. For what is expected to happen now and then, such as
// a time step that is too long; mistakes of the caller and damaged files are exceptions.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace sim {

/// One sentence without a full stop.
struct Rejection {
  std::string reason;
  bool final = false;  ///< a smaller attempt would come to the same
};

template <class T>
class Attempt {
 public:
  Attempt(T value) : result_(std::move(value)) {}
  Attempt(Rejection rejection) : result_(std::move(rejection)) {}

  explicit operator bool() const { return std::holds_alternative<T>(result_); }
  const T& operator*() const { return std::get<T>(result_); }
  T& operator*() { return std::get<T>(result_); }
  const T* operator->() const { return &std::get<T>(result_); }
  T* operator->() { return &std::get<T>(result_); }
  const Rejection& rejection() const { return std::get<Rejection>(result_); }
  /// The value where there must be one; throws std::runtime_error with the reason otherwise.
  T value() && {
    if (!*this) throw std::runtime_error(rejection().reason);
    return std::move(std::get<T>(result_));
  }

 private:
  std::variant<T, Rejection> result_;
};

/// f(), an Attempt. What has no geometry, a surface that is none or one that crosses another, throws std::domain_error
/// from deep below: it is rejected.
template <class F>
auto within_domain(F&& f) -> decltype(f()) try {
  return f();
} catch (const std::domain_error& error) {
  return Rejection{error.what()};
}

}  // namespace sim
