// Names of files are UTF-8 in vantage, as texts are. The C++ library asks Windows to convert them by the code page of
// the user instead, which lacks most characters. What it calls for that is here, so that the linker looks no further:
// for this module alone, not for others of the process.
#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>

namespace {

template <class Function>
Function of_system(const char* name) {
  return reinterpret_cast<Function>(
      reinterpret_cast<void*>(::GetProcAddress(::GetModuleHandleW(L"kernel32.dll"), name)));
}

UINT instead_of(UINT code_page) { return code_page == CP_ACP || code_page == CP_OEMCP ? CP_UTF8 : code_page; }

using ToBytes = int(WINAPI*)(UINT, DWORD, LPCWCH, int, LPSTR, int, LPCCH, LPBOOL);
using ToWide = int(WINAPI*)(UINT, DWORD, LPCCH, int, LPWSTR, int);

int WINAPI to_bytes(UINT code_page, DWORD flags, LPCWCH wide, int count, LPSTR bytes, int room, LPCCH other,
                    LPBOOL used) {
  static const auto convert = of_system<ToBytes>("WideCharToMultiByte");
  const UINT chosen = instead_of(code_page);
  if (chosen != code_page) return convert(chosen, 0, wide, count, bytes, room, nullptr, nullptr);
  return convert(code_page, flags, wide, count, bytes, room, other, used);
}

int WINAPI to_wide(UINT code_page, DWORD flags, LPCCH bytes, int count, LPWSTR wide, int room) {
  static const auto convert = of_system<ToWide>("MultiByteToWideChar");
  const UINT chosen = instead_of(code_page);
  return convert(chosen, chosen != code_page ? 0 : flags, bytes, count, wide, room);
}

}  // namespace

// As an import library has them: the pointers that headers of Windows name.
extern "C" {
ToBytes vantage_to_bytes __asm__("__imp_WideCharToMultiByte") = to_bytes;
ToWide vantage_to_wide __asm__("__imp_MultiByteToWideChar") = to_wide;
}
