// SPDX-License-Identifier: BSD-3-Clause
// Structs as Python classes, made of one table of fields each: constructor, attributes, repr,
// equality, dict and pickle all follow from the table, and every default is read from the C++
// struct.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include "python_types.hpp"
#include "value_type.hpp"

namespace iksel::python {

struct Field {
  const char* name;
  const char* doc;
  std::size_t offset;  ///< of the member in its struct
  const ValueType* type;

  [[nodiscard]] void* of(void* self) const { return static_cast<char*>(self) + offset; }
  [[nodiscard]] const void* of(const void* self) const {
    return static_cast<const char*>(self) + offset;
  }
};

/// A struct whose type is known at run time only.
struct StructType {
  const char* name;
  const char* doc;
  std::vector<Field> fields;
  const std::type_info* cpp_type;
  const void* defaults;
  void* (*copy)(const void* self);
  void (*destroy)(void* self);
  /// Throws InvalidArgumentError naming the first field out of range.
  void (*validate)(const void* self);
  /// What else to say about a name that is no field; may be null.
  std::string (*hint)(const std::string& name);
};

/// Specialised for every struct: kName, kDoc, fields() as a vector of Field.
template <class Struct>
struct FieldTable;

template <class T, class = void>
struct HasFields : std::false_type {};
template <class T>
struct HasFields<T, std::void_t<decltype(FieldTable<T>::fields())>> : std::true_type {};

template <class T, class = void>
struct CanValidate : std::false_type {};
template <class T>
struct CanValidate<T, std::void_t<decltype(std::declval<const T&>().validate())>> : std::true_type {
};

template <class T, class = void>
struct HasHint : std::false_type {};
template <class T>
struct HasHint<T, std::void_t<decltype(&FieldTable<T>::hint)>> : std::true_type {};

template <class Struct>
auto hint_of() -> std::string (*)(const std::string&) {
  if constexpr (HasHint<Struct>::value) {
    return &FieldTable<Struct>::hint;
  } else {
    return nullptr;
  }
}

template <class Struct, class T>
Field field(const char* name, T Struct::*member, const char* doc) {
  return {name, doc, offset_of(member), &value_type<T>()};
}

template <class Struct>
const StructType& struct_type() {
  static const StructType type{
      FieldTable<Struct>::kName,
      FieldTable<Struct>::kDoc,
      FieldTable<Struct>::fields(),
      &typeid(Struct),
      &defaults_of<Struct>(),
      [](const void* self) -> void* { return new Struct(as<Struct>(self)); },
      [](void* self) { delete static_cast<Struct*>(self); },
      [](const void* self) {
        if constexpr (CanValidate<Struct>::value) as<Struct>(self).validate();
      },
      hint_of<Struct>(),
  };
  return type;
}

/// "Name(field=value, ...)" over the fields that differ from the default.
std::string to_repr(const void* self, const StructType& type);
template <class Struct>
std::string to_repr(const Struct& self) {
  return to_repr(&self, struct_type<Struct>());
}

py::dict to_dict(const void* self, const StructType& type);
bool equal_fields(const void* a, const void* b, const StructType& type);

/// Sets the fields that a mapping names. Throws SignatureError on a name that is none.
void assign(void* self, const StructType& type, const py::dict& changes);

/// The Python class itself or a mapping of its fields, assigned to what `self` is.
void read_struct(void* self, const StructType& type, py::handle value, const char* name);

template <class Struct>
struct FromPython<Struct, std::enable_if_t<HasFields<Struct>::value>> {
  static Struct convert(py::handle value, const char* name) {
    if (py::isinstance<Struct>(value)) return py::cast<const Struct&>(value);
    Struct out{};
    read_struct(&out, struct_type<Struct>(), value, name);
    return out;
  }
};

template <class T>
struct ValueOf<T, std::enable_if_t<HasFields<T>::value>> {
  static constexpr bool kHasShortRepr = false;
  static std::string attribute() { return std::string("iksel_cpp.") + FieldTable<T>::kName; }
  static std::string argument() { return attribute() + " | collections.abc.Mapping[str, object]"; }
  static py::object get(T& value, py::handle owner) {
    return py::cast(value, py::return_value_policy::reference_internal, owner);
  }
  static py::object to_plain(const T& value) { return to_dict(&value, struct_type<T>()); }
  static std::string repr(const T& value) { return to_repr(value); }
  static bool equal(const T& a, const T& b) { return equal_fields(&a, &b, struct_type<T>()); }
};

/// Which parts of a class follow from the table.
enum class FieldClass {
  result,     ///< read-only attributes
  immutable,  ///< a keyword constructor and replace() as well
  options,    ///< and attributes that can be set
};

/// Adds attributes, repr, equality, dict and pickle.
void add_fields(py::object cls, const StructType& type, FieldClass kind);

template <class Struct>
py::class_<Struct> bind_fields(py::module_& m, FieldClass kind) {
  py::class_<Struct> cls(m, FieldTable<Struct>::kName, FieldTable<Struct>::kDoc);
  add_fields(cls, struct_type<Struct>(), kind);
  return cls;
}

}  // namespace iksel::python
