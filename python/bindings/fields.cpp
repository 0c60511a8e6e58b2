// SPDX-License-Identifier: BSD-3-Clause
#include "fields.hpp"

#include <memory>
#include <utility>

#include "method.hpp"
#include "signature.hpp"

namespace iksel::python {

namespace {

using Owned = std::unique_ptr<void, void (*)(void*)>;

Owned copy_of(const void* self, const StructType& type) { return {type.copy(self), type.destroy}; }

std::string class_name(const StructType& type) { return std::string("iksel_cpp.") + type.name; }

/// The struct in a Python object, or null if that is of another class.
void* find(py::handle object, const StructType& type) {
  py::detail::type_caster_generic caster(*type.cpp_type);
  return caster.load(object, /*convert=*/false) ? caster.value : nullptr;
}

void* unwrap(py::handle self, const StructType& type) {
  if (void* found = find(self, type)) return found;
  throw SignatureError(std::string("self: expected a ") + type.name + ", got " + describe(self));
}

py::object wrap(Owned self, const StructType& type) {
  const auto* info = py::detail::get_type_info(*type.cpp_type);
  py::object object = py::reinterpret_steal<py::object>(py::detail::type_caster_generic::cast(
      self.get(), py::return_value_policy::take_ownership, {}, info, nullptr, nullptr));
  self.release();
  return object;
}

[[noreturn]] void throw_no_field(const std::string& name, const StructType& type) {
  std::vector<std::string> names;
  std::string possible;
  for (const Field& field : type.fields) {
    names.emplace_back(field.name);
    possible += (possible.empty() ? "" : ", ") + std::string(field.name);
  }
  const std::string hint = type.hint == nullptr ? "" : type.hint(name);
  throw SignatureError(std::string(type.name) + ": no field '" + name + "'" +
                       (hint.empty() ? did_you_mean(name, names) : hint) +
                       "; possible: " + possible);
}

/// Signature and text of a method that takes all fields as keywords.
struct KeywordDoc {
  std::string signature;
  std::string text;
};

KeywordDoc keyword_doc(const StructType& type, const std::string& result, bool show_defaults,
                       const char* text) {
  std::string signature;
  std::string arguments;
  for (const Field& field : type.fields) {
    const bool shown = show_defaults && field.type->has_short_repr;
    const std::string value = shown ? field.type->repr(field.of(type.defaults)) : "...";
    signature += std::string(", ") + field.name + ": " + field.type->argument + " = " + value;
    arguments += std::string("\n    ") + field.name + ": " + field.doc;
  }
  return {"(self: " + class_name(type) + ", *" + signature + ") -> " + result,
          std::string(text) + "\n\nArgs:" + arguments +
              "\n\nRaises:\n    SignatureError: a keyword that is no field.\n"
              "    InvalidArgumentError: a value of the wrong type or out of range."};
}

void add_attribute(const py::object& cls, const StructType& type, const Field& field,
                   bool writable) {
  py::options options;
  options.disable_function_signatures();
  const std::string self = "(self: " + class_name(type);
  const std::string getter = self + ") -> " + field.type->attribute + "\n";
  const std::string setter = self + ", value: " + field.type->argument + ") -> None\n";
  const py::cpp_function get(
      [&type, &field](const py::object& object) {
        return field.type->get(field.of(unwrap(object, type)), object);
      },
      py::is_method(cls), getter.c_str());
  py::object set = py::none();
  if (writable) {
    set = py::cpp_function(
        [&type, &field](const py::object& object, const py::object& value) {
          field.type->set(field.of(unwrap(object, type)), value, field.name);
        },
        py::is_method(cls), py::arg("value"), setter.c_str());
  }
  const py::handle property(reinterpret_cast<PyObject*>(&PyProperty_Type));
  cls.attr(field.name) = property(get, set, py::none(), field.doc);
}

/// What __getstate__ gave, checked as options are.
Owned from_state(const py::object& state, const StructType& type) {
  if (!py::isinstance<py::dict>(state)) throw_wrong_type(type.name, "a dict of fields", state);
  Owned self = copy_of(type.defaults, type);
  assign(self.get(), type, state);
  type.validate(self.get());
  return self;
}

void add_conversions(py::object& cls, const StructType& type) {
  const std::string self = "(self: " + class_name(type);
  def(cls, "to_dict", self + ") -> dict[str, object]",
      "All fields by name as plain Python data, with the names of enums in their place.",
      [&type](const py::object& object) { return to_dict(unwrap(object, type), type); });
  def(cls, "__repr__", self + ") -> str", "",
      [&type](const py::object& object) { return to_repr(unwrap(object, type), type); });
  def(
      cls, "__eq__", self + ", other: object) -> object", "",
      [&type](const py::object& object, const py::object& other) -> py::object {
        const void* a = unwrap(object, type);
        const void* b = find(other, type);
        if (b == nullptr) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
        return py::bool_(equal_fields(a, b, type));
      },
      py::arg("other"));
  def(
      cls, "__getstate__", self + ", /) -> object", "",
      [&type](const py::object& object) { return to_dict(unwrap(object, type), type); },
      py::pos_only());
  def(
      cls, "__setstate__", self + ", arg0: object) -> None", "",
      [&type](py::detail::value_and_holder& place, const py::object& state) {
        place.value_ptr() = from_state(state, type).release();
      },
      py::detail::is_new_style_constructor());
}

Owned changed(const void* self, const StructType& type, const py::dict& changes) {
  Owned copy = copy_of(self, type);
  assign(copy.get(), type, changes);
  type.validate(copy.get());
  return copy;
}

void add_keywords(py::object& cls, const StructType& type) {
  const KeywordDoc init = keyword_doc(type, "None", /*show_defaults=*/true,
                                      "Fields that are not given keep their default.");
  def(
      cls, "__init__", init.signature, init.text,
      [&type](py::detail::value_and_holder& place, const py::kwargs& fields) {
        place.value_ptr() = changed(type.defaults, type, fields).release();
      },
      py::detail::is_new_style_constructor());
  const KeywordDoc replace = keyword_doc(type, class_name(type), /*show_defaults=*/false,
                                         "A copy in which the given fields have another value.");
  def(cls, "replace", replace.signature, replace.text,
      [&type](const py::object& object, const py::kwargs& changes) {
        return wrap(changed(unwrap(object, type), type, changes), type);
      });
}

}  // namespace

std::string to_repr(const void* self, const StructType& type) {
  std::string text;
  for (const Field& field : type.fields) {
    const void* value = field.of(self);
    if (field.type->equal(value, field.of(type.defaults))) continue;
    text += (text.empty() ? "" : ", ") + std::string(field.name) + "=" + field.type->repr(value);
  }
  return std::string(type.name) + "(" + text + ")";
}

py::dict to_dict(const void* self, const StructType& type) {
  py::dict dict;
  for (const Field& field : type.fields) dict[field.name] = field.type->to_plain(field.of(self));
  return dict;
}

bool equal_fields(const void* a, const void* b, const StructType& type) {
  for (const Field& field : type.fields) {
    if (!field.type->equal(field.of(a), field.of(b))) return false;
  }
  return true;
}

void assign(void* self, const StructType& type, const py::dict& changes) {
  for (const auto& [key, value] : changes) {
    if (!py::isinstance<py::str>(key)) throw SignatureError("field names are strings");
    const auto name = py::cast<std::string>(key);
    const Field* found = nullptr;
    for (const Field& field : type.fields) {
      if (name == field.name) found = &field;
    }
    if (found == nullptr) throw_no_field(name, type);
    found->type->set(found->of(self), value, found->name);
  }
}

void read_struct(void* self, const StructType& type, py::handle value, const char* name) {
  if (!py::hasattr(value, "keys")) {
    throw_wrong_type(name, std::string(type.name) + " or a mapping of its fields", value);
  }
  assign(self, type, py::dict(py::reinterpret_borrow<py::object>(value)));
}

void add_fields(py::object cls, const StructType& type, FieldClass kind) {
  for (const Field& field : type.fields) {
    add_attribute(cls, type, field, kind == FieldClass::options);
  }
  add_conversions(cls, type);
  if (kind != FieldClass::result) add_keywords(cls, type);
}

}  // namespace iksel::python
