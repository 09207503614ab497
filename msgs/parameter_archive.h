// Parameters in archives: what was saved with others is refused.
#pragma once

#include <string>
#include <variant>

#include "msgs/archive.h"
#include "msgs/parameter.h"

namespace maploop {

// Saves every parameter of a table; loading refuses other values and names the first of them.
template <class Archive, class P>
void archive_same_parameters(Archive& ar, const ParameterTable<P>& table, const P& values) {
  for (const Parameter<P>& parameter : table.parameters) {
    const auto same = [&]<class T>(const T& own) {
      T saved = own;
      ar(saved);
      if constexpr (Archive::loading) {
        if (saved == own) return;
        ar.fail("it was saved with " + std::string(table.name) + '.' + std::string(parameter.key) +
                " = " + text_of(saved) + ", and here it is " + text_of(own));
      }
    };
    std::visit(same, parameter.value_in(values));
  }
}
template <class Archive, class P>
void archive_same_parameters(Archive& ar, const P& values) {
  archive_same_parameters(ar, parameter_table(values), values);
}

}  // namespace maploop
