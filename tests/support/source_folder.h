/// \file Where the sources lie, for tests that read the sample models or the sources themselves.
#pragma once
#include <string>

namespace batten::test {

/// Without a slash at its end. One source of the tests knows it, so that no other object depends on the folder it is
/// built in.
std::string source_folder();

}  // namespace batten::test
