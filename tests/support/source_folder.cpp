#include "support/source_folder.h"

namespace batten::test {

std::string source_folder() { return BATTEN_SOURCE_DIR; }

}  // namespace batten::test
