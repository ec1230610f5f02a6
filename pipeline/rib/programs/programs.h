/// Programs that answer requests with RIB: Procedural "RunProgram" (RISpec 5.8). They run until the reader
/// ends.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/rib/programs/program_answer.h"

namespace trapeze::rib {

/// One is owned by each reading. Programs are told apart by their whole command line: the same program with
/// other words runs beside the first, and each keeps between its
/// requests what it has loaded.
class Programs {
  public:
    Programs();
    ~Programs();
    Programs(const Programs&) = delete;
    Programs& operator=(const Programs&) = delete;

    /// The words of a command line, the program's name first.
    using Command = std::vector<std::string>;

    /// Sends a request to the program of a command (no shell). The first request starts the program; its name
    /// is looked for in the folders, then in PATH. A program that does not answer within the limits is ended,
    /// with all that it has started in its group, and is asked no more.
    ProgramAnswer ask(const Command& command, const std::string& request,
                      const std::vector<std::string>& folders, const AnswerLimits& limits);

  private:
    class Program;
    std::map<Command, std::unique_ptr<Program>> programs_;  ///< null: has failed
};

/// Ends all programs that this process runs, at once; for a process that is about to be ended by force. May
/// be called from any thread.
void end_all_programs();

}  // namespace trapeze::rib
