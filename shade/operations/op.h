/// The operations of the grid machine, which the built-in functions and operators of the shading language
/// become. In an Instruction the outputs stand first, then the inputs.
///
/// Widths: a register has 1, 3 or 16 floats. Where an operation is by component, a float input of a triple
/// output serves all its components. Bools are lane masks: all bits of a lane set, or none. Strings are
/// uniform.
#pragma once

#include <cstdint>
#include <string_view>

namespace trapeze::rsl {

enum class Op : uint8_t {
    // By component.
    Move,  ///< out = a; a float fills a triple; for a matrix, c * identity
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Select,  ///< out = mask ? a : b
    Sqrt,
    InverseSqrt,
    Abs,
    Sign,
    Floor,
    Ceil,
    Round,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,  ///< atan(y, x)
    Pow,
    Mod,  ///< a - b * floor(a / b)
    Min,
    Max,
    Step,        ///< step(edge, x)
    Clamp,       ///< clamp(x, low, high)
    Mix,         ///< mix(a, b, t): t of width 1 or 3
    SmoothStep,  ///< smoothstep(low, high, x)

    // Bools.
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,  ///< of all components; also of strings
    And,
    Or,
    Not,
    ToBool,   ///< x != 0
    ToFloat,  ///< 1 or 0

    // Parts of values.
    Triple,            ///< out = (a, b, c)
    Sixteen,           ///< out = the matrix of 16 floats, by rows
    Component,         ///< out = v[k]; k clamped to 0..2
    SetComponent,      ///< v (output, keeps the rest), k, x
    MatrixElement,     ///< out = m[i][j]
    SetMatrixElement,  ///< m (output, keeps the rest), i, j, x
    Element,           ///< out = array[index]; the index is rounded down and clamped
    SetElement,        ///< array (output, keeps the rest), index, value
    Clear,             ///< array: all elements become 0, or empty texts

    // Geometry.
    Dot,
    Cross,
    Length,
    Distance,
    Normalize,     ///< a zero vector stays zero
    FaceForward,   ///< N, I, Nref: sign(-I.Nref) * N
    Reflect,       ///< I, N
    Refract,       ///< I, N, eta; zero for total reflection
    Fresnel,       ///< outputs Kr, Kt [, R, T]; I, N, eta
    Rotate,        ///< p, angle, a, b: about the line from a to b
    LineDistance,  ///< ptlined(a, b, q): from q to the segment a b
    MatrixMultiply,
    MatrixDivide,
    Invert,
    Determinant,
    TranslateMatrix,  ///< translate(m, v)
    ScaleMatrix,      ///< scale(m, v)
    RotateMatrix,     ///< rotate(m, angle, axis)
    TransformPoint,   ///< m, p: row vectors, divided by w
    TransformVector,
    TransformNormal,
    SpaceMatrix,  ///< out = the matrix from space `from` to space `to` (strings; "" is current)

    // Colour. ConvertColor: from, to (strings), c.
    ConvertColor,
    // Noise: coordinates of 1 to 4 dimensions (float; float, float; triple; triple, float); out of width 1
    // or 3.
    Noise,
    CellNoise,
    PeriodicNoise,  ///< coordinates, then as many periods
    Random,         ///< no inputs: 0..1, different at each vertex and call
    Spline,         ///< [basis (string),] value, knots or one array

    // Over neighbours.
    Du,     ///< x, u, v
    Dv,     ///< x, u, v
    Deriv,  ///< num, den, u, v
    Area,
    CalculateNormal,
    FilterStep,  ///< edge, x [, x2] [, name, value, ...]
    Depth,

    // Strings.
    Concat,
    Format,
    Match,
    Print,

    // Maps: name, channel, positional inputs (count in `immediate`), then name, value, ...
    Texture,
    Environment,
    Shadow,
    Bump,
    TextureInfo,  ///< outputs: found (float), value; name, what

    // Light.
    Ambient,       ///< P
    Diffuse,       ///< P, N
    Specular,      ///< P, N, V, roughness
    Phong,         ///< P, N, V, size
    SpecularBrdf,  ///< L, N, V, roughness
    Trace,         ///< P, R; out of width 1 (distance) or 3 (colour)
    Transmission,  ///< from, to, name, value, ...
    Visibility,    ///< from, to
    Occlusion,     ///< P, N, samples, name, value, ...
    IndirectDiffuse,
    RayInfo,  ///< outputs: found, value; what
    RayLevel,

    // Messages. Outputs: found (float), value (kept when not found); inputs: the name.
    LightMessage,
    SurfaceMessage,
    DisplacementMessage,
    AtmosphereMessage,
    IncidentMessage,
    OppositeMessage,
    AttributeMessage,
    OptionMessage,
    RendererInfo,
    ShaderName,  ///< [kind]

    // Control. Blocks nest and are closed in order.
    If,  ///< condition (Bool)
    Else,
    EndIf,
    Loop,      ///< lanes that run now take part
    LoopTest,  ///< condition: lanes where it is false leave
    LoopStep,  ///< lanes that continued take part again
    EndLoop,
    Break,
    Continue,  ///< `immediate` loops out
    Scope,     ///< a function's body that returns from its middle
    Leave,     ///< to the end of the innermost Scope, out of all loops in it
    EndScope,
    /// Loop over lights. Outputs L, Cl; inputs: category (string), P [, axis, angle]. A loop for Break.
    Illuminance,
    EndIlluminance,
    /// In lights. Outputs L; inputs: Ps, from [, axis, angle].
    Illuminate,
    EndIlluminate,
    /// In lights. Outputs L; inputs: axis, angle; or Ns alone, light from all sides.
    Solar,
    EndSolar,
    Gather,
    GatherElse,
    EndGather,

    /// Built-in functions that code generation writes as other operations, and that no program contains.
    LogBase,
    Radians,
    Degrees,
    TransformPointNamed,
    TransformVectorNamed,
    TransformNormalNamed,
    TransformMatrixNamed,
    ArrayLength,
    IsOutput,     ///< whether an output variable is wanted: 1
    Unavailable,  ///< of later renderers: the compiler warns
};

/// As the listing of a program names it.
std::string_view op_name(Op op);

}  // namespace trapeze::rsl
