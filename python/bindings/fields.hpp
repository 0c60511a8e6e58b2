// SPDX-License-Identifier: BSD-3-Clause
// Structs as Python classes, made of one table of fields each: constructor, attributes, repr,
// equality, dict and pickle all follow from the table, every default is read from the C++ struct,
// and names and texts are those of the core's headers.
#pragma once

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "value_type.hpp"

namespace iksel::python {

struct Field {
  const char* name;
  const char* doc;     ///< null: it is part of the pickle, and no attribute
  std::size_t offset;  ///< of the member in its struct
  const ValueType* type;
  /// Throws InvalidArgumentError about a value that a pickle may not have; may be null.
  void (*check)(const void* value, const std::string& name) = nullptr;

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
  const void* defaults;
  /// What a Python object holds. Throws SignatureError about one of another class.
  void* (*unwrap)(py::handle self);
};

template <class T>
T argument_of(void (*check)(T, const std::string&));

/// The fields of a struct as its header, or that of its base `Declared`, has them; of
/// void none.
template <class Struct, class Declared = Struct>
class HeaderFields {
 public:
  HeaderFields() {
    if constexpr (!std::is_void_v<Declared>) {
      Members<Declared>::visit([this](const char* key, auto member) {
        add(std::strchr(key, '.') + 1, member, header_text(key));
      });
    }
  }

  /// One that the header has not; no attribute without a text.
  template <class Base, class T>
  HeaderFields& add(const char* name, T Base::*member, const char* doc = nullptr) {
    all_.push_back({name, doc, offset_of<Struct, T>(member), &value_type<T>()});
    return *this;
  }

  /// Those that are part of the pickle, and no attributes.
  HeaderFields& hide(std::initializer_list<const char*> names) {
    for (const char* name : names) at(name).doc = nullptr;
    return *this;
  }

  /// Those whose values in a pickle are looked at by kCheck(value, name).
  template <auto kCheck>
  HeaderFields& check(std::initializer_list<const char*> names) {
    using T = decltype(argument_of(kCheck));
    for (const char* name : names) {
      if (at(name).type != &value_type<T>()) throw std::logic_error(name);
      at(name).check = [](const void* value, const std::string& of) { kCheck(as<T>(value), of); };
    }
    return *this;
  }

  const std::vector<Field>& all() const { return all_; }

 private:
  Field& at(const char* name) {
    for (Field& each : all_) {
      if (std::strcmp(each.name, name) == 0) return each;
    }
    throw std::logic_error(name);
  }

  std::vector<Field> all_;
};

/// Specialised for every struct that is bound by its fields, as derived from HeaderTable; if need
/// be with other fields() and check(), which throws InvalidArgumentError about
/// fields that do not fit each other.
template <class Struct>
struct FieldTable;

template <class Struct, class Declared = Struct>
struct HeaderTable {
  static constexpr const char* kName = Members<Declared>::kName;
  static const char* doc() { return header_text(Members<Declared>::kName); }
  static std::vector<Field> fields() { return HeaderFields<Struct, Declared>().all(); }
  static void check(const Struct& /*self*/) {}
};

template <class T, class = void>
struct HasFields : std::false_type {};
template <class T>
struct HasFields<T, std::void_t<decltype(FieldTable<T>::fields())>> : std::true_type {};

template <class T, class = void>
struct CanValidate : std::false_type {};
template <class T>
struct CanValidate<T, std::void_t<decltype(std::declval<const T&>().validate())>> : std::true_type {
};

/// Throws InvalidArgumentError naming the first field out of range.
template <class Struct>
void check_struct(const Struct& self) {
  if constexpr (CanValidate<Struct>::value) self.validate();
  FieldTable<Struct>::check(self);
}

template <class Struct>
const StructType& struct_type() {
  using Table = FieldTable<Struct>;
  static const StructType type{
      Table::kName,
      Table::doc(),
      Table::fields(),
      &defaults_of<Struct>(),
      [](py::handle self) -> void* { return &made<Struct>(self); },
  };
  return type;
}

/// "Lanes(damping=0.1)": the fields that are not at their default.
std::string to_repr(const void* self, const StructType& type);
template <class Struct>
std::string to_repr(const Struct& self) {
  return to_repr(&self, struct_type<Struct>());
}

py::dict to_dict(const void* self, const StructType& type);

/// Sets the fields that a mapping names. Throws SignatureError on a name that is none.
void assign(void* self, const StructType& type, const py::dict& changes);

/// As assign(), of all fields, as to_dict() gave them.
void assign_state(void* self, const StructType& type, py::handle state);

/// A mapping of fields, assigned to what `self` is.
void read_struct(void* self, const StructType& type, py::handle value, const char* name);

template <class Struct>
struct FromPython<Struct, std::enable_if_t<HasFields<Struct>::value>> {
  static std::string text() {
    const bool has_class = ClassOf<Struct>::type != nullptr;
    return (has_class ? "iksel_cpp." + ClassOf<Struct>::name + " | " : "") +
           "collections.abc.Mapping[str, object]";
  }
  static Struct convert(py::handle value, const char* name) {
    if (is_a<Struct>(value)) return made<Struct>(value);
    Struct out{};
    read_struct(&out, struct_type<Struct>(), value, name);
    return out;
  }
};

template <class T>
struct ValueOf<T, std::enable_if_t<HasFields<T>::value>> {
  static py::object get(T& value, py::handle owner) {
    using Policy = py::return_value_policy;
    return py::cast(value, owner ? Policy::reference_internal : Policy::copy, owner);
  }
  static py::object to_plain(const T& value) { return to_dict(&value, struct_type<T>()); }
};

/// Signature and text of a method that takes all fields as keywords.
std::string keyword_doc(const StructType& type, const char* name, const std::string& result,
                        bool show_defaults, const char* text);
void add_attributes(const py::object& cls, const StructType& type, bool writable);

template <class Struct>
Struct changed(Struct copy, const py::dict& changes) {
  assign(&copy, struct_type<Struct>(), changes);
  check_struct(copy);
  return copy;
}

template <class Struct>
Struct from_state(const py::object& state) {
  Struct self{};
  assign_state(&self, struct_type<Struct>(), state);
  check_struct(self);
  return self;
}

/// Read-only attributes, repr as iksel._base.show has it, and pickling.
template <class Struct>
py::class_<Struct> bind_fields(py::module_& m, const char* how, bool writable = false) {
  const StructType& type = struct_type<Struct>();
  auto cls = bind_class<Struct>(m, type.name, how, type.doc);
  add_attributes(cls, type, writable);
  def(cls, "__getstate__", "",
      [](const Struct& self) { return to_dict(&self, struct_type<Struct>()); });
  def_init(
      cls, "state", [](const py::object& state) { return from_state<Struct>(state); }, "",
      "__setstate__");
  def_repr(cls);
  return cls;
}

/// As values: to_dict(), repr and equality as well.
template <class Struct>
py::class_<Struct> bind_values(py::module_& m, const char* how, bool writable = false) {
  auto cls = bind_fields<Struct>(m, how, writable);
  def(
      cls, "to_dict", "", [](const Struct& self) { return to_dict(&self, struct_type<Struct>()); },
      "All fields by name as plain Python data, with the names of enums in their place.");
  def(cls, "__repr__", "", [](const Struct& self) { return to_repr(self); });
  def(cls, "__eq__", "other", [](const Struct& self, const py::object& other) -> py::object {
    if (!is_a<Struct>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
    const auto plain = [](const Struct& of) { return to_dict(&of, struct_type<Struct>()); };
    return py::bool_(plain(self).equal(plain(made<Struct>(other))));
  });
  return cls;
}

/// As options: a constructor and replace() as well; with attributes to be set if `writable`.
template <class Struct>
py::class_<Struct> bind_keyword_class(py::module_& m, bool writable) {
  const StructType& type = struct_type<Struct>();
  auto cls = bind_values<Struct>(m, nullptr, writable);
  def_init(
      cls, "", [](const Keywords& fields) { return changed(Struct{}, fields); },
      keyword_doc(type, "__init__", "None", /*show_defaults=*/true,
                  "Fields that are not given keep their default."));
  def(
      cls, "replace", "",
      [](const Struct& self, const Keywords& changes) { return changed(self, changes); },
      keyword_doc(type, "replace", type_text<Struct>(), /*show_defaults=*/false,
                  "A copy in which the given fields have another value."));
  return cls;
}

}  // namespace iksel::python
