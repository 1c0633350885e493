/// \file The word that a misspelt one most likely stands for.
#pragma once
#include <string>
#include <vector>

namespace batten {

/// The word that `word` most likely stands for: the start of one, or the one with the fewest letters to change, insert,
/// drop or swap, at most a third of them. Empty if none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

/// " (did you mean WORD?)", or nothing if no word is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& words);

}  // namespace batten
