#include "shade/materials/sent_names.h"

#include "shade/rsl/syntax/ast.h"

namespace trapeze {

/// Names stand behind the plain inputs, each in front of its value, and are constants.
void add_sent_names(const rsl::Program& program, std::set<std::string>& names) {
    for (const rsl::Instruction& i : program.code) {
        if (i.op != rsl::Op::Illuminance) continue;
        for (size_t k = static_cast<size_t>(i.immediate); k + 1 < i.input_count(); k += 2)
            for (const std::string& name : program.reg(i.input(k)).texts)
                if (name.starts_with(rsl::kSendToLight)) names.insert(name.substr(rsl::kSendToLight.size()));
    }
}

}  // namespace trapeze
