#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace snare::python {

/// An object of T as the argument of a bound function, refused where it was made by __new__ without __init__:
/// pybind11 itself would pass memory that holds nothing.
template <class T>
struct Ready {
  const T* object = nullptr;
  const T* operator->() const { return object; }
  const T& operator*() const { return *object; }
};

}  // namespace snare::python

namespace pybind11::detail {

template <class T>
struct type_caster<snare::python::Ready<T>> {
  PYBIND11_TYPE_CASTER(snare::python::Ready<T>, make_caster<T>::name);

  bool load(handle source, bool /*convert*/) {
    if (!isinstance<T>(source)) return false;
    const auto place =
        reinterpret_cast<instance*>(source.ptr())->get_value_and_holder(get_type_info(typeid(T)));
    if (!place.holder_constructed()) {
      const std::string kind = str(type::handle_of(source).attr("__name__"));
      throw type_error("this " + kind +
                       " was made by __new__ and holds no law; a law comes from Law(file) or from distil");
    }
    value.object = static_cast<const T*>(place.value_ptr());
    return true;
  }
};

}  // namespace pybind11::detail
