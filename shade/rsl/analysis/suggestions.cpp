#include "shade/rsl/analysis/suggestions.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace trapeze::rsl {
namespace {

constexpr size_t kLongest = 64;  // names compared

/// Letters to insert, leave out, replace or exchange with the next, counting upper and lower case as one half
/// of a change: twice the number of changes. The usual table by dynamic programming, of which only the last
/// three rows are kept; now[j] is the distance of the first i letters of `a` and the first j of `b`.
size_t distance(std::string_view a, std::string_view b) {
    const auto same = [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
    };
    std::vector<size_t> two_back(b.size() + 1), back(b.size() + 1), now(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) now[j] = 2 * j;
    for (size_t i = 1; i <= a.size(); ++i) {
        two_back.swap(back);
        back.swap(now);
        now[0] = 2 * i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t replace = a[i - 1] == b[j - 1] ? 0 : same(a[i - 1], b[j - 1]) ? 1 : 2;
            now[j] = std::min({back[j] + 2, now[j - 1] + 2, back[j - 1] + replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = std::min(now[j], two_back[j - 2] + 2);
        }
    }
    return now[b.size()];
}

}  // namespace

// A third of the letters may differ, at most three; of very short names only the case.
Suggestion::Suggestion(std::string_view written)
    : written_(written), least_(written.size() < 3 ? 2 : std::min<size_t>(2 * (written.size() / 3) + 1, 7)) {}

/// Distances are only worked out for names of about the same length, and for so many: scenes are full of
/// names. Of names equally near the first counts.
void Suggestion::consider(std::string_view candidate) {
    if (candidate.size() > kLongest || written_.size() > kLongest || candidate.empty()) return;
    const size_t longer = std::max(candidate.size(), written_.size()),
                 shorter = std::min(candidate.size(), written_.size());
    if (2 * (longer - shorter) >= least_ || ++considered_ > kMostConsidered) return;
    const size_t far = distance(written_, candidate);
    if (far == 0 || far >= least_) return;
    least_ = far;
    best_ = candidate;
}

std::string Suggestion::text() const {
    return best_.empty() ? std::string() : " (did you mean \"" + std::string(best_) + "\"?)";
}

}  // namespace trapeze::rsl
