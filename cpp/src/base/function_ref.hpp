// SPDX-License-Identifier: BSD-3-Clause
// A reference to something callable, for calls that outlive no statement: unlike std::function it
// never allocates.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace iksel {

template <typename Signature>
class FunctionRef;

template <typename R, typename... Args>
class FunctionRef<R(Args...)> {
 public:
  template <typename F,
            typename = std::enable_if_t<!std::is_same_v<std::decay_t<F>, FunctionRef<R(Args...)>>>>
  FunctionRef(const F& function)  // NOLINT(google-explicit-constructor)
      : object_(std::addressof(function)), call_([](const void* object, Args... args) -> R {
          return (*static_cast<const F*>(object))(std::forward<Args>(args)...);
        }) {}

  R operator()(Args... args) const { return call_(object_, std::forward<Args>(args)...); }

 private:
  const void* object_;
  R (*call_)(const void*, Args...);
};

}  // namespace iksel
