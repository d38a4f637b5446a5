// numpy arrays over the memory of a flow's fields.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

namespace tailwater {

/// Lends one field as numpy views without a copy. A view that Python keeps beyond its step keeps its values: `settle`
/// then gives the flow a copy of the field, and the view keeps the old memory.
template <class T>
class Lender {
 public:
  explicit Lender(std::vector<T>& field) : field_(field) {}
  Lender(const Lender&) = delete;
  Lender& operator=(const Lender&) = delete;
  ~Lender() { settle(); }

  /// The first `count` entries as an array of shape (count, components), or (count) where `components` is 1.
  template <class Number>
  pybind11::array view(std::size_t count, std::size_t components, bool is_writable = false) {
    if (!memory_) memory_ = std::make_shared<std::vector<T>>();
    auto* share = new std::shared_ptr<std::vector<T>>(memory_);
    const pybind11::capsule owner(share, [](void* p) { delete static_cast<std::shared_ptr<std::vector<T>>*>(p); });
    std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(count)};
    std::vector<pybind11::ssize_t> strides{sizeof(T)};
    if (components > 1) {
      shape.push_back(static_cast<pybind11::ssize_t>(components));
      strides.push_back(sizeof(Number));
    }
    const auto* numbers = reinterpret_cast<const Number*>(field_.data());
    pybind11::array view(pybind11::dtype::of<Number>(), shape, strides, numbers, owner);
    if (!is_writable) view.attr("setflags")(pybind11::arg("write") = false);
    return view;
  }

  /// Call before the field changes or is destroyed.
  void settle() {
    if (memory_.use_count() > 1) {
      std::vector<T> copy = field_;
      memory_->swap(field_);
      field_ = std::move(copy);
    }
    memory_.reset();
  }

 private:
  std::vector<T>& field_;
  std::shared_ptr<std::vector<T>> memory_;  ///< empty as long as the flow owns the memory of the field
};

}  // namespace tailwater
