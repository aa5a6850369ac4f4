// The functions of PROJ that are used, found at run time. PROJ brings 40 libraries with it (curl, Kerberos, LDAP,
// GnuTLS, ...): to load them takes longer than a small mission, and a scene without a place on the earth needs none.
#pragma once

#include <geodesic.h>
#include <proj.h>

namespace vantage::internal::geo {

#define VANTAGE_PROJ_FUNCTIONS(X)             \
  X(geod_init)                                \
  X(geod_inverse)                             \
  X(geod_direct)                              \
  X(proj_context_create)                      \
  X(proj_context_destroy)                     \
  X(proj_context_set_enable_network)          \
  X(proj_context_set_fileapi)                 \
  X(proj_context_set_search_paths)            \
  X(proj_context_get_database_path)           \
  X(proj_context_get_user_writable_directory) \
  X(proj_context_errno_string)                \
  X(proj_log_func)                            \
  X(proj_create)                              \
  X(proj_create_crs_to_crs_from_pj)           \
  X(proj_normalize_for_visualization)         \
  X(proj_destroy)                             \
  X(proj_is_crs)                              \
  X(proj_get_type)                            \
  X(proj_get_name)                            \
  X(proj_get_id_auth_name)                    \
  X(proj_get_id_code)                         \
  X(proj_get_source_crs)                      \
  X(proj_get_area_of_use)                     \
  X(proj_crs_get_sub_crs)                     \
  X(proj_crs_get_coordinate_system)           \
  X(proj_cs_get_axis_count)                   \
  X(proj_cs_get_axis_info)                    \
  X(proj_trans)                               \
  X(proj_errno)                               \
  X(proj_errno_reset)

struct ProjLibrary {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a member's name
#define VANTAGE_MEMBER(name) decltype(&::name) name = nullptr;
  VANTAGE_PROJ_FUNCTIONS(VANTAGE_MEMBER)
#undef VANTAGE_MEMBER
};

/// Loaded with the first call, by any thread, for the rest of the program; that takes about 10 ms. Throws Error(input)
/// where PROJ is not installed, or lacks a function. Builds with VANTAGE_LINK_PROJ have it in them instead.
const ProjLibrary& proj();

}  // namespace vantage::internal::geo
