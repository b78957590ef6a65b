#pragma once
// The controls and languages of NC programs.

namespace driftwright {

enum class NcControl { kLinuxCnc, kSiemens, kHeidenhain };

/// The language of a program, found from its text: Siemens programs may switch to ISO code (G291), Heidenhain ones are
/// DIN/ISO or plain language.
enum class NcDialect {
  kLinuxCnc,       ///< RS-274 as LinuxCNC reads it
  kSiemens,        ///< Siemens language mode (G290)
  kSiemensIso,     ///< ISO mode (G291): words as in RS-274, G20 and G21
  kHeidenhainIso,  ///< %NAME G71 *
  kKlartext,       ///< BEGIN PGM NAME MM
};

}  // namespace driftwright
