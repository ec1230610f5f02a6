#include "shade/rsl/syntax/printer.h"

#include <charconv>
#include <cstdio>

#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {
namespace {

// Precedences as the parser has them: those of kBinary in parse_expressions.cpp, then - and ! and casts, and
// above all what needs no parentheses anywhere.
constexpr int kUnary = 9, kPrimary = 10;

struct Written {
    std::string_view mark;
    int precedence;
};

/// An operator's mark and how tightly it binds. The same precedences as the parser's table: what is printed
/// has to read back as the same tree.
Written written(Operator op) {
    switch (op) {
        case Operator::Or:
            return {"||", 1};
        case Operator::And:
            return {"&&", 2};
        case Operator::Equal:
            return {"==", 3};
        case Operator::NotEqual:
            return {"!=", 3};
        case Operator::Less:
            return {"<", 4};
        case Operator::LessEqual:
            return {"<=", 4};
        case Operator::Greater:
            return {">", 4};
        case Operator::GreaterEqual:
            return {">=", 4};
        case Operator::Add:
            return {"+", 5};
        case Operator::Subtract:
            return {"-", 5};
        case Operator::Cross:
            return {"^", 6};
        case Operator::Multiply:
            return {"*", 7};
        case Operator::Divide:
            return {"/", 7};
        case Operator::Dot:
            return {".", 8};
        case Operator::Negate:
            return {"-", kUnary};
        case Operator::Not:
            return {"!", kUnary};
        case Operator::None:
            break;
    }
    return {"", kPrimary};
}

/// Whether an expression begins with a variable's name.
bool names_a_variable(const Expression& e) {
    return e.kind == Expression::Kind::Variable || e.kind == Expression::Kind::Element;
}

/// The shortest text that reads as the same float; infinity as a number that is too large for one.
std::string number_text(float value) {
    if (value > 3.4e38f) return "1e39";
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

/// A string in quotation marks; token_values.cpp reads its escapes. Bytes beyond ASCII stay as they are.
/// Octal escapes always have three digits, so that a digit behind one is not taken for part of it.
std::string escaped(std::string_view value) {
    std::string text = "\"";
    for (const char c : value) {
        if (c == '"' || c == '\\') {
            text += '\\';
            text += c;
        } else if (c == '\n') {
            text += "\\n";
        } else if (static_cast<unsigned char>(c) < 32 || c == 127) {
            char octal[8];
            std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned char>(c));
            text += octal;
        } else {
            text += c;
        }
    }
    return text + '"';
}

/// Writes a tree with as few parentheses as parse to the same one: an operand gets some where it binds less
/// tightly than its place wants.
class Printer {
  public:
    std::string text;

    void function(const Function& f) {
        text += f.result_structure            ? f.result_structure->name
                : f.result.base == Base::Void ? "void"
                                              : std::string(name_of(f.result.base));
        text += " " + f.name.substr(f.method_of ? f.name.find("->") + 2 : 0);
        head(f.parameters);
        block(*f.body);
        text += '\n';
    }

    /// With the methods that are among these functions.
    void structure(const Struct& s, const std::vector<std::unique_ptr<Function>>& functions) {
        text += "struct " + s.name + (s.base ? " : " + s.base->name : "") + " {";
        for (size_t i = s.base ? s.base->members.size() : 0; i < s.members.size(); ++i) {
            text += ' ';
            variable(*s.members[i]);
            text += ';';
        }
        for (const auto& f : functions) {
            if (f->method_of != &s) continue;
            text += ' ';
            function(*f);
        }
        text += " }\n";
    }

    void shader(const Shader& s) {
        text += std::string(name_of(s.kind)) + " " + s.name;
        head(s.parameters);
        block(*s.body);
        text += '\n';
    }

    /// In parentheses when it binds less tightly than `least`: -1 is an assignment, 0 a "?:", and from 1 on
    /// the precedences of written(). -1 lets everything stand bare.
    void expression(const Expression& e, int least = -1) {
        const bool wrap = precedence(e) < least;
        if (wrap) text += '(';
        bare(e);
        if (wrap) text += ')';
    }

  private:
    /// Begins a line, four blanks further in for each level of blocks.
    void line_start() { text += '\n' + std::string(static_cast<size_t>(indent_) * 4, ' '); }

    /// "(float a = 1; color c) ".
    void head(const std::vector<std::unique_ptr<Variable>>& parameters) {
        text += '(';
        const char* separator = "";
        for (const auto& parameter : parameters) {
            text += separator;
            variable(*parameter);
            separator = "; ";
        }
        text += ") ";
    }

    void variable(const Variable& v) {
        if (v.external) text += "extern ";
        if (v.output) text += "output ";
        if (v.structure) {
            const std::string_view storage = v.storage == Storage::Uniform   ? "uniform "
                                             : v.storage == Storage::Varying ? "varying "
                                                                             : "";
            text += std::string(storage) + v.structure->name + " ";
        } else {
            text += print(Type{v.type.base, 0}, v.storage) + " ";
        }
        declarator(v);
    }

    /// "a[3] = {1, 2, 3}": what stands behind the type. An unsized array is one of a function's parameters.
    void declarator(const Variable& v) {
        text += v.name;
        if (v.type.length == Type::kUnsized) text += "[]";
        if (v.type.length > 0) text += "[" + std::to_string(v.type.length) + "]";
        if (!v.initial) return;
        text += " = ";
        expression(*v.initial);
    }

    void block(const Statement& s) {
        text += '{';
        ++indent_;
        for (const StatementPtr& child : s.children) {
            line_start();
            statement(*child);
        }
        --indent_;
        line_start();
        text += '}';
    }

    /// The statement of an if or loop: behind its head, on the same line.
    void body(const Statement& s) {
        text += ' ';
        statement(s);
    }

    /// Values with commas between them; null stands for one that was left out.
    void list(const std::vector<ExpressionPtr>& expressions) {
        bool first = true;
        for (const ExpressionPtr& e : expressions) {
            if (!first) text += ", ";
            first = false;
            if (e) expression(*e);
        }
    }

    /// A word, its arguments, the statement within, and what follows an else.
    void with_head(std::string_view word, const Statement& s) {
        text += word;
        text += '(';
        list(s.expressions);
        text += ')';
        body(*s.children[0]);
        if (s.children.size() < 2) return;
        line_start();
        text += "else";
        body(*s.children[1]);
    }

    /// "for (a; b; c, d, ...)": the first three expressions are the head's parts, the rest further steps.
    void for_statement(const Statement& s) {
        text += "for (";
        for (size_t i = 0; i < s.expressions.size(); ++i) {
            if (i > 0) text += i < 3 ? "; " : ", ";
            if (s.expressions[i]) expression(*s.expressions[i]);
        }
        text += ')';
        body(*s.children[0]);
    }

    /// "break;", or with the number of loops if it is not one.
    void jump(std::string_view word, const Statement& s) {
        text += word;
        if (s.levels != 1) text += " " + std::to_string(s.levels);
        text += ';';
    }

    void if_statement(const Statement& s) {
        // An if without else right before "else" would take that.
        const bool hides = s.children.size() > 1 && ends_with_open_if(*s.children[0]);
        if (!hides) return with_head("if ", s);
        text += "if (";
        expression(*s.expressions[0]);
        text += ") { ";
        statement(*s.children[0]);
        text += " } else";
        body(*s.children[1]);
    }

    /// Whether an "else" right behind the statement would belong to an if within it. Braces end the search.
    static bool ends_with_open_if(const Statement& s) {
        if (s.kind == Statement::Kind::Block || s.children.empty()) return false;
        if ((s.kind == Statement::Kind::If || s.kind == Statement::Kind::Gather) && s.children.size() == 1)
            return true;
        return ends_with_open_if(*s.children.back());
    }

    /// "f(a, b)", or "a->f(b)" of a method.
    void call(const Expression& e) {
        const bool is_method = e.text.starts_with("->") && !e.children.empty();
        if (is_method) expression(*e.children[0], kPrimary);
        text += e.text + "(";
        for (size_t i = is_method ? 1 : 0; i < e.children.size(); ++i) {
            if (i > (is_method ? 1u : 0u)) text += ", ";
            expression(*e.children[i]);
        }
        text += ')';
    }

    void statement(const Statement& s);
    void bare(const Expression& e);
    static int precedence(const Expression& e);

    int indent_ = 0;
};

/// How tightly the expression's outermost operator binds. A cast that is not printed binds as its operand
/// does, and a negative number as the minus sign that it is printed with.
int Printer::precedence(const Expression& e) {
    switch (e.kind) {
        case Expression::Kind::Assignment:
            return -1;
        case Expression::Kind::Conditional:
            return 0;
        case Expression::Kind::Binary:
            return written(e.op).precedence;
        case Expression::Kind::Unary:
            return kUnary;
        case Expression::Kind::Cast:
            return e.implicit ? precedence(*e.children[0]) : kUnary;
        case Expression::Kind::Number:
            return e.number < 0 ? kUnary : kPrimary;
        default:
            return kPrimary;
    }
}

/// The expression without parentheses of its own. Who calls it has decided by the precedence of what stands
/// around whether parentheses are needed.
void Printer::bare(const Expression& e) {
    switch (e.kind) {
        case Expression::Kind::Number:
            text += number_text(e.number);
            break;
        case Expression::Kind::Text:
            text += escaped(e.text);
            break;
        case Expression::Kind::Variable:
            text += e.text;
            break;
        case Expression::Kind::Element:
            expression(*e.children[0], kPrimary);
            text += '[';
            expression(*e.children[1]);
            text += ']';
            break;
        case Expression::Kind::Member:
            expression(*e.children[0], kPrimary);
            text += "->" + e.text;
            break;
        case Expression::Kind::Unary:
            text += written(e.op).mark;
            expression(*e.children[0], kUnary);
            break;
        case Expression::Kind::Binary: {
            // Left-associative: the right operand needs parentheses already when it binds as tightly.
            const Written op = written(e.op);
            expression(*e.children[0], op.precedence);
            text += " " + std::string(op.mark) + " ";
            expression(*e.children[1], op.precedence + 1);
            break;
        }
        case Expression::Kind::Conditional:
            expression(*e.children[0], 1);
            text += " ? ";
            expression(*e.children[1]);
            text += " : ";
            expression(*e.children[2], 0);
            break;
        case Expression::Kind::Triple:
        case Expression::Kind::Sixteen:
            text += '(';
            list(e.children);
            text += ')';
            break;
        case Expression::Kind::List:
            text += '{';
            list(e.children);
            text += e.repeats ? ", ...}" : "}";
            break;
        case Expression::Kind::Cast:
            if (e.implicit) return bare(*e.children[0]);
            text += name_of(e.type.base);
            text += ' ';
            if (!e.text.empty()) text += escaped(e.text) + " ";
            // "vector P" at a statement's beginning would be a declaration.
            expression(*e.children[0], names_a_variable(*e.children[0]) ? kPrimary + 1 : kUnary);
            break;
        case Expression::Kind::Call:
            call(e);
            break;
        case Expression::Kind::Assignment:
            expression(*e.children[0], kPrimary);
            text += " " + std::string(written(e.op).mark) + "= ";
            expression(*e.children[1]);
            break;
    }
}

/// One statement, from where the line stands now. A nested function is printed in the place of the Empty
/// statement that it left behind.
void Printer::statement(const Statement& s) {
    switch (s.kind) {
        case Statement::Kind::Block:
            return block(s);
        case Statement::Kind::Declare:
            for (size_t i = 0; i < s.variables.size(); ++i) {
                if (i > 0) text += ", ";
                variable(*s.variables[i]);
            }
            text += ';';
            return;
        case Statement::Kind::Evaluate:
            expression(*s.expressions[0]);
            text += ';';
            return;
        case Statement::Kind::If:
            return if_statement(s);
        case Statement::Kind::While:
            return with_head("while ", s);
        case Statement::Kind::For:
            return for_statement(s);
        case Statement::Kind::Illuminance:
            return with_head("illuminance", s);
        case Statement::Kind::Illuminate:
            return with_head("illuminate", s);
        case Statement::Kind::Solar:
            return with_head("solar", s);
        case Statement::Kind::Gather:
            return with_head("gather", s);
        case Statement::Kind::Break:
            return jump("break", s);
        case Statement::Kind::Continue:
            return jump("continue", s);
        case Statement::Kind::Return:
            text += "return";
            if (!s.expressions.empty()) {
                text += ' ';
                expression(*s.expressions[0]);
            }
            text += ';';
            return;
        case Statement::Kind::Empty:
            if (s.defines)
                function(*s.defines);
            else
                text += ';';
            return;
    }
}

}  // namespace

std::string print(const Type& type, Storage storage) {
    std::string text = storage == Storage::Uniform   ? "uniform "
                       : storage == Storage::Varying ? "varying "
                                                     : "";
    text += type.base == Base::Void ? "void" : std::string(name_of(type.base));
    if (type.length == Type::kUnsized) text += "[]";
    if (type.length > 0) text += "[" + std::to_string(type.length) + "]";
    return text;
}

std::string print(const Struct& structure) {
    Printer printer;
    printer.structure(structure, {});
    return printer.text;
}

std::string print(const Expression& expression) {
    Printer printer;
    printer.expression(expression);
    return printer.text;
}

/// Structs first. Nested functions are printed with the shader that they stand in, all others before any
/// shader.
std::string print(const TranslationUnit& unit) {
    Printer printer;
    for (const auto& structure : unit.structs) printer.structure(*structure, unit.functions);
    for (const auto& function : unit.functions)
        if (function->inside.empty() && !function->method_of) printer.function(*function);
    for (const auto& shader : unit.shaders) printer.shader(*shader);
    return printer.text;
}

}  // namespace trapeze::rsl
