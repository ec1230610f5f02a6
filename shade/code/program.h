/// A shader as three-address code: what code generation makes of the tree, the optimiser improves and the
/// grid machine runs.
///
/// A program has no jumps to addresses: control is in blocks that open and close (op_table.def), since what
/// runs is a whole grid, of whose vertices some may take one way and some another. Nor are there functions:
/// they are written out where they are called.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "shade/operations/op.h"
#include "shade/rsl/syntax/type.h"

namespace trapeze::rsl {

/// Index into Program::registers.
using RegisterId = uint32_t;

/// A value with a name or without one. It may be written by several instructions, unless it is a temporary:
/// code is not in single-assignment form, for a masked write leaves old values in some lanes, and so every
/// write to a variable would also be a read of it.
struct Register {
    enum class Kind : uint8_t {
        Constant,
        Parameter,
        Global,  ///< a predefined variable
        Local,
        Temporary,  ///< written by one instruction, and read in its block or deeper ones
    };
    Kind kind = Kind::Temporary;
    Type type;
    bool varying = false;  ///< set by infer_storage()
    uint32_t region = 0;   ///< where it lives: see Instruction::region
    /// Of an array of no length in its type: the registers of its number of elements, and of how many were
    /// reserved.
    RegisterId count = 0, reserved = 0;
    std::string name;                ///< as in the source; empty for constants and temporaries
    std::vector<float> values;       ///< of a Constant
    std::vector<std::string> texts;  ///< of a Constant of strings
};

/// One operation. What it does to lanes that do not run, and whether it does it once or for each, is found
/// last.
struct Instruction {
    Op op = Op::Move;
    uint8_t outputs = 0;
    /// Lanes that do not run must keep what they have: the output outlives the region of the program in which
    /// lanes were switched off. Set by infer_storage().
    bool masked = false;
    bool varying = false;              ///< of a block's opening: lanes take different ways; of any other:
                                       ///< it is to be done for each lane
    int32_t immediate = 0;             ///< as op.h says
    uint32_t region = 0;               ///< number of the innermost block around it; 0: none
    std::vector<RegisterId> operands;  ///< outputs first
    SourceLocation at;

    /// Operands are outputs and then inputs, in the order of the operation's row in op_table.def.
    RegisterId output(size_t i = 0) const { return operands[i]; }
    /// Operands are the outputs first, then the inputs.
    size_t input_count() const { return operands.size() - outputs; }
    RegisterId input(size_t i) const { return operands[outputs + i]; }
};

using Code = std::vector<Instruction>;

/// A parameter of the shader. Its default is code of its own, for it may be any expression of what stands
/// before it; an instance that gives the parameter a value leaves the code out.
struct ProgramParameter {
    std::string name;
    Type type;
    Storage storage = Storage::Uniform;
    bool output = false;
    RegisterId id = 0;
    Code initial;  ///< computes the default into the register
    SourceLocation at;
};

/// One shader of a source. Registers are never taken out, so that ids stay good through all passes; varying
/// ones that nothing names get no memory (plane_slots.h).
struct Program {
    ShaderKind kind = ShaderKind::Surface;
    std::string name;
    std::vector<Register> registers;
    std::vector<ProgramParameter> parameters;
    Code code;
    bool directional = false;  ///< a light with illuminate or solar; without, it is ambient
    bool displaces = false;    ///< there is a displacement shader of the same name that belongs to it

    const Register& reg(RegisterId id) const { return registers[id]; }
    /// A predefined variable's register, if the program names it.
    const RegisterId* find_global(std::string_view global) const {
        for (size_t i = 0; i < globals.size(); ++i)
            if (registers[globals[i]].name == global) return &globals[i];
        return nullptr;
    }
    std::vector<RegisterId> globals;  ///< registers of kind Global, each name once
};

/// Text of a program, an instruction a line, for people.
std::string listing(const Program& program);

}  // namespace trapeze::rsl
