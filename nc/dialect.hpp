#pragma once
// Whose language an NC program is written in.

namespace driftwright {

enum class NcControl { kLinuxCnc, kSiemens, kHeidenhain };

/// How a program is written, as its text says: Siemens programs may ask for ISO code (G291), Heidenhain ones are DIN/ISO or plain language.
enum class NcDialect {
  kLinuxCnc,       ///< RS-274 as LinuxCNC reads it
  kSiemens,        ///< Siemens language mode (G290)
  kSiemensIso,     ///< ISO mode (G291): words as of RS-274, G20 and G21
  kHeidenhainIso,  ///< %NAME G71 *
  kKlartext,       ///< BEGIN PGM NAME MM
};

}  // namespace driftwright
