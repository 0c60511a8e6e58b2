// SPDX-License-Identifier: BSD-3-Clause
// Structs as Python classes, made of one table of fields each: constructor, attributes, repr,
// equality, dict and pickle all follow from the table, and every default is read from the C++
// struct.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

#include <array>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "python_types.hpp"
#include "signature.hpp"

namespace iksel::python {

template <class Struct, class T>
struct Field {
  const char* name;
  T Struct::*member;
  const char* doc;
};

template <class Struct, class T>
constexpr Field<Struct, T> field(const char* name, T Struct::*member, const char* doc) {
  return {name, member, doc};
}

/// Specialised for every struct: kName, kDoc, fields() as a tuple of Field.
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

template <class Struct, class Visitor>
void for_each_field(const Visitor& visit) {
  std::apply([&](const auto&... each) { (visit(each), ...); }, FieldTable<Struct>::fields());
}

template <class T>
struct IsArray : std::false_type {};
template <std::size_t N>
struct IsArray<std::array<double, N>> : std::true_type {};

/// A sequence of N numbers.
template <std::size_t N>
struct FromPython<std::array<double, N>> {
  static std::array<double, N> convert(py::handle value, const char* name) {
    const std::string expected = std::to_string(N) + " numbers";
    if (!py::isinstance<py::sequence>(value) && !py::hasattr(value, "__array__")) {
      throw_wrong_type(name, expected, value);
    }
    const py::list items(py::reinterpret_borrow<py::object>(value));
    if (items.size() != N) throw_wrong_type(name, expected, value);
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = from_python<double>(items[i], name);
    return out;
  }
};

template <class Struct>
std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for_each_field<Struct>([&](const auto& f) { names.emplace_back(f.name); });
  return names;
}

using FieldDict = py::typing::Dict<py::str, py::object>;

template <class Struct>
FieldDict to_dict(const Struct& values);
template <class Struct>
std::string to_repr(const Struct& values);

/// A value as plain Python data: enums by name, structs as dicts.
template <class T>
py::object to_plain(const T& value) {
  if constexpr (HasFields<T>::value) {
    return to_dict(value);
  } else if constexpr (std::is_enum_v<T>) {
    return py::str(enum_name(value));
  } else if constexpr (IsArray<T>::value) {
    py::tuple items(value.size());
    for (std::size_t i = 0; i < value.size(); ++i) items[i] = value[i];
    return items;
  } else {
    return py::cast(value);
  }
}

template <class T>
bool equal(const T& a, const T& b) {
  if constexpr (HasFields<T>::value) {
    bool same = true;
    for_each_field<T>([&](const auto& f) { same = same && equal(a.*f.member, b.*f.member); });
    return same;
  } else {
    return a == b;
  }
}

template <class Struct>
FieldDict to_dict(const Struct& values) {
  FieldDict dict;
  for_each_field<Struct>([&](const auto& f) { dict[f.name] = to_plain(values.*f.member); });
  return dict;
}

/// "Name(field=value, ...)" over the fields that differ from the default.
template <class Struct>
std::string to_repr(const Struct& values) {
  const Struct defaults{};
  std::string text;
  for_each_field<Struct>([&](const auto& f) {
    if (equal(values.*f.member, defaults.*f.member)) return;
    text += (text.empty() ? "" : ", ") + std::string(f.name) + "=";
    if constexpr (HasFields<std::decay_t<decltype(values.*f.member)>>::value) {
      text += to_repr(values.*f.member);
    } else {
      text += py::cast<std::string>(py::repr(to_plain(values.*f.member)));
    }
  });
  return std::string(FieldTable<Struct>::kName) + "(" + text + ")";
}

template <class Struct>
[[noreturn]] void throw_no_field(const std::string& name) {
  const std::vector<std::string> names = field_names<Struct>();
  std::string possible;
  for (const std::string& each : names) possible += (possible.empty() ? "" : ", ") + each;
  throw SignatureError(std::string(FieldTable<Struct>::kName) + ": no field '" + name + "'" +
                       did_you_mean(name, names) + "; possible: " + possible);
}

/// Sets the fields that `changes` names. Throws SignatureError on a name that is none.
template <class Struct>
void assign(Struct& values, const py::dict& changes) {
  for (const auto& [key, value] : changes) {
    if (!py::isinstance<py::str>(key)) throw SignatureError("field names are strings");
    const auto name = py::cast<std::string>(key);
    bool known = false;
    for_each_field<Struct>([&, &value = value](const auto& f) {
      if (name != f.name) return;
      known = true;
      using T = std::decay_t<decltype(values.*f.member)>;
      values.*f.member = from_python<T>(value, f.name);
    });
    if (!known) throw_no_field<Struct>(name);
  }
}

/// The Python class itself or a mapping of its fields.
template <class Struct>
struct FromPython<Struct, std::enable_if_t<HasFields<Struct>::value>> {
  static Struct convert(py::handle value, const char* name) {
    if (py::isinstance<Struct>(value)) return py::cast<Struct>(value);
    if (!py::hasattr(value, "keys")) {
      throw_wrong_type(name, std::string(FieldTable<Struct>::kName) + " or a mapping of its fields",
                       value);
    }
    Struct values{};
    assign(values, py::dict(py::reinterpret_borrow<py::object>(value)));
    return values;
  }
};

/// The type of a field as an argument, for signatures.
template <class T>
std::string argument_type() {
  if constexpr (HasFields<T>::value) {
    return std::string("iksel_cpp.") + FieldTable<T>::kName +
           " | collections.abc.Mapping[str, object]";
  } else if constexpr (std::is_enum_v<T>) {
    return std::string("iksel_cpp.") + EnumTable<T>::kName + " | str";
  } else if constexpr (std::is_same_v<T, bool>) {
    return "bool";
  } else if constexpr (IsArray<T>::value) {
    return "collections.abc.Sequence[float]";
  } else {
    return std::is_integral_v<T> ? "int" : "float";
  }
}

/// A docstring that starts with a signature over all fields as keywords.
template <class Struct>
std::string keyword_doc(const char* function, const char* result, bool show_defaults,
                        const char* text) {
  const Struct defaults{};
  std::string signature;
  std::string arguments;
  for_each_field<Struct>([&](const auto& f) {
    using T = std::decay_t<decltype(defaults.*f.member)>;
    std::string value = "...";
    if constexpr (!HasFields<T>::value) {
      if (show_defaults) value = py::cast<std::string>(py::repr(to_plain(defaults.*f.member)));
    }
    signature += std::string(", ") + f.name + ": " + argument_type<T>() + " = " + value;
    arguments += std::string("\n    ") + f.name + ": " + f.doc;
  });
  return std::string(function) + "(self: iksel_cpp." + FieldTable<Struct>::kName + ", *" +
         signature + ") -> " + result + "\n\n" + text + "\n\nArgs:" + arguments +
         "\n\nRaises:\n    SignatureError: a keyword that is no field.\n"
         "    InvalidArgumentError: a value of the wrong type or out of range.";
}

/// Attributes, repr, equality, dict and pickle.
template <class Struct>
py::class_<Struct> bind_fields(py::module_& m, bool writable) {
  using Table = FieldTable<Struct>;
  py::class_<Struct> cls(m, Table::kName, Table::kDoc);
  for_each_field<Struct>([&](const auto& f) {
    using T = std::decay_t<decltype(std::declval<Struct>().*f.member)>;
    if constexpr (IsArray<T>::value) {
      // A copy, and unchangeable, so that nobody takes it for the struct's own.
      cls.def_property_readonly(
          f.name,
          [member = f.member](const Struct& self) {
            const auto& [x, y, z] = self.*member;
            return py::typing::Tuple<py::float_, py::float_, py::float_>(py::make_tuple(x, y, z));
          },
          f.doc);
      return;
    } else {
      const py::cpp_function get([member = f.member](Struct& self) -> T& { return self.*member; },
                                 py::is_method(cls), py::return_value_policy::reference_internal);
      if (!writable) {
        cls.def_property_readonly(f.name, get, f.doc);
        return;
      }
      const py::cpp_function set(
          [member = f.member, name = f.name](Struct& self, const Loose<T>& value) {
            self.*member = from_python<T>(value, name);
          },
          py::is_method(cls), py::arg("value"));
      cls.def_property(f.name, get, set, f.doc);
    }
  });
  cls.def("to_dict", &to_dict<Struct>,
          "All fields by name as plain Python data, with the names of enums in their place.");
  cls.def("__repr__", &to_repr<Struct>);
  cls.def(
      "__eq__",
      [](const Struct& self, const py::object& other) -> py::object {
        if (!py::isinstance<Struct>(other)) {
          return py::reinterpret_borrow<py::object>(Py_NotImplemented);
        }
        return py::bool_(equal(self, py::cast<const Struct&>(other)));
      },
      py::arg("other"));
  cls.def(py::pickle([](const Struct& self) -> py::object { return to_dict(self); },
                     [](const py::object& state) {
                       if (!py::isinstance<py::dict>(state)) {
                         throw_wrong_type(FieldTable<Struct>::kName, "a dict of fields", state);
                       }
                       Struct values{};
                       assign(values, state);
                       if constexpr (CanValidate<Struct>::value) values.validate();
                       return values;
                     }));
  return cls;
}

/// As bind_fields with writable attributes, a keyword constructor and replace().
template <class Struct>
py::class_<Struct> bind_options_class(py::module_& m, bool writable = true) {
  auto cls = bind_fields<Struct>(m, writable);
  py::options signatures;
  signatures.disable_function_signatures();
  const std::string init_doc = keyword_doc<Struct>("__init__", "None", /*show_defaults=*/true,
                                                   "Fields that are not given keep their default.");
  cls.def(py::init([](const py::kwargs& fields) {
            Struct values{};
            assign(values, fields);
            values.validate();
            return values;
          }),
          init_doc.c_str());
  const std::string result = std::string("iksel_cpp.") + FieldTable<Struct>::kName;
  const std::string replace_doc =
      keyword_doc<Struct>("replace", result.c_str(), /*show_defaults=*/false,
                          "A copy in which the given fields have another value.");
  cls.def(
      "replace",
      [](const Struct& self, const py::kwargs& changes) {
        Struct values = self;
        assign(values, changes);
        values.validate();
        return values;
      },
      replace_doc.c_str());
  return cls;
}

}  // namespace iksel::python
