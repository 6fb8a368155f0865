#pragma once

namespace vigia {

/// One visitor out of several lambdas, for std::visit: an alternative without its lambda does not
/// compile.
template <typename... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <typename... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace vigia
