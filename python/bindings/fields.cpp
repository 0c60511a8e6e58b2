// SPDX-License-Identifier: BSD-3-Clause
#include "fields.hpp"

namespace iksel::python {

namespace {

const Field& find_field(py::handle key, const StructType& type) {
  if (!py::isinstance<py::str>(key)) throw SignatureError("field names are strings");
  const auto name = as_text(key, "field");
  for (const Field& field : type.fields) {
    if (name == field.name) return field;
  }
  py::list known;
  for (const Field& field : type.fields) known.append(field.name);
  throw SignatureError(py::cast<std::string>(
      of_package("iksel._base.keywords", "no_field")(type.name, name, known)));
}

/// Whether a plain value is that of a struct, or of a variant of them.
bool is_struct(py::handle plain) { return py::isinstance<py::dict>(plain); }

}  // namespace

std::string to_repr(const void* self, const StructType& type) {
  std::string text;
  for (const Field& field : type.fields) {
    const py::object plain = field.type->to_plain(field.of(self));
    if (plain.equal(field.type->to_plain(field.of(type.defaults)))) continue;
    // Structs, of which there is a copy where nobody owns it, show what they are themselves.
    const py::object shown =
        is_struct(plain) ? field.type->get(const_cast<void*>(field.of(self)), {}) : plain;
    text += (text.empty() ? "" : ", ") + std::string(field.name) + "=" + repr_text(shown);
  }
  return std::string(type.name) + "(" + text + ")";
}

py::dict to_dict(const void* self, const StructType& type) {
  py::dict dict;
  for (const Field& field : type.fields) dict[field.name] = field.type->to_plain(field.of(self));
  return dict;
}

void assign(void* self, const StructType& type, const py::dict& changes) {
  for (const auto& [key, value] : changes) {
    const Field& field = find_field(key, type);
    field.type->set(field.of(self), value, field.name, -1);
  }
}

void assign_state(void* self, const StructType& type, py::handle state) {
  const std::string of = std::string("pickled ") + type.name;
  const py::dict values = copy_of_dict(state, of);
  for (const auto& [key, value] : values) {
    const Field& field = find_field(key, type);
    const std::string name = of + ", " + field.name;
    field.type->set(field.of(self), value, name.c_str(), -1);
    if (field.check != nullptr) field.check(field.of(self), name);
  }
  if (values.size() != type.fields.size()) {
    throw InvalidArgumentError(of + ": expected a dict of " + std::to_string(type.fields.size()) +
                               " fields, got " + std::to_string(values.size()));
  }
}

void read_struct(void* self, const StructType& type, py::handle value, const char* name) {
  if (!py::hasattr(value, "keys")) {
    throw_wrong_type(name, std::string(type.name) + " or a mapping of its fields", value);
  }
  assign(self, type, py::dict(py::reinterpret_borrow<py::object>(value)));
}

std::string keyword_doc(const StructType& type, const char* name, const std::string& result,
                        bool show_defaults, const char* text) {
  std::string signature;
  std::string arguments;
  for (const Field& field : type.fields) {
    const py::object plain = field.type->to_plain(field.of(type.defaults));
    const std::string value = show_defaults && !is_struct(plain) ? repr_text(plain) : "...";
    signature += std::string(", ") + field.name + ": " + field.type->argument + " = " + value;
    arguments += std::string("\n    ") + field.name + ": " + field.doc;
  }
  return std::string(name) + "(self: iksel_cpp." + type.name + ", *" + signature + ") -> " +
         result + "\n\n" + text + "\n\nArgs:" + arguments +
         "\n\nRaises:\n    SignatureError: a keyword that is no field.\n"
         "    InvalidArgumentError: a value of the wrong type or out of range.\n";
}

void add_attributes(const py::object& cls, const StructType& type, bool writable) {
  for (const Field& field : type.fields) {
    if (field.doc == nullptr) continue;
    Setter set;
    if (writable) {
      set = [&type, &field](py::handle self, py::handle value) {
        field.type->set(field.of(type.unwrap(self)), value, field.name, -1);
      };
    }
    set_property(
        cls, field.name, field.type->attribute,
        [&type, &field](py::handle self) {
          return field.type->get(field.of(type.unwrap(self)), self);
        },
        field.doc, field.type->argument, set);
  }
}

}  // namespace iksel::python
