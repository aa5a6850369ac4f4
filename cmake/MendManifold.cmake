# Changes four things in Manifold before it is compiled. The release itself stays as it was fetched: the changed copy is
# in the build folder.
# - Where Manifold::Impl::DedupeEdge takes apart two sheets that touch along an edge, it copies the vertex at the edge's
#   start, but gives the copy the position of the edge's end: a corner of the result jumps along that edge. It happens
#   where the two operands almost coincide. Wrong in all releases up to 3.5.4.
# - Facets that are folded back into a plane, as booleans leave them where solids touch, get the plane's normal, the
#   wrong way round for them. Manifold::Impl::SwapDegenerates then takes them for facets without area, and gives a corner
#   of theirs to the neighbour beyond their longest side, wherever that lies: a surface jumped by centimetres. Facets
#   that are turned over are left alone.
# - Where malloc has no more memory, it is told by an exception: checked_malloc.h.
# - Built with threads, Manifold::Impl::DedupeEdges sorts the edges of large meshes; without, it takes them as they come:
#   the page, which has no threads, would make other volumes than the program.
function(vantage_mend_manifold source_dir)
  set(original ${source_dir}/src/edge_op.cpp)
  set(mended_dir ${CMAKE_CURRENT_BINARY_DIR}/third_party/manifold_mended)
  set(wrong "// Split the pinched vert the previous split created.
    const int newVert = vertPos_.size();
    vertPos_.push_back(vertPos_[endVert]);
    if (vertNormal_.size() > 0) vertNormal_.push_back(vertNormal_[endVert]);
")
  set(right "// Split the pinched vert the previous split created.
    const int newVert = vertPos_.size();
    vertPos_.push_back(vertPos_[startVert]);  // changed by vantage: was endVert
    if (vertNormal_.size() > 0) vertNormal_.push_back(vertNormal_[startVert]);
")
  set(unsorted "      localLoop(0, nbEdges, local, duplicates);
")
  set(sorted "${unsorted}      if (nbEdges > 1e4)  // changed by vantage: as with threads
        manifold::stable_sort(duplicates.begin(), duplicates.end());
")
  set(flat_or_turned "    if (CCW(v[0], v[1], v[2], tolerance_) > 0 || !Is01Longest(v[0], v[1], v[2]))
      return false;
")
  set(flat "    // changed by vantage: was > 0
    if (CCW(v[0], v[1], v[2], tolerance_) != 0 || !Is01Longest(v[0], v[1], v[2]))
      return false;
")
  set(any_neighbour "    return CCW(v[0], v[1], v[2], tolerance_) > 0 ||
           Is01Longest(v[0], v[1], v[2]);
")
  set(no_turned_neighbour "    // changed by vantage: the neighbour is not turned over
    const int way = CCW(v[0], v[1], v[2], tolerance_);
    return way > 0 || (way == 0 && Is01Longest(v[0], v[1], v[2]));
")
  set(flat_or_turned_again "  if (CCW(v[0], v[1], v[2], tolerance_) > 0 || !Is01Longest(v[0], v[1], v[2]))
    return;
")
  set(flat_again "  // changed by vantage: was > 0
  if (CCW(v[0], v[1], v[2], tolerance_) != 0 || !Is01Longest(v[0], v[1], v[2]))
    return;
")
  set(turned_beyond "  // Only operate if the other triangles are not degenerate.
  if (CCW(v[1], v[0], v[3], tolerance_) <= 0) {
")
  set(not_turned_beyond "  // changed by vantage: the neighbour is not turned over
  if (CCW(v[1], v[0], v[3], tolerance_) < 0) return;
${turned_beyond}")
  file(READ ${original} text)
  foreach(change "wrong;right" "unsorted;sorted" "flat_or_turned;flat" "any_neighbour;no_turned_neighbour"
          "flat_or_turned_again;flat_again" "turned_beyond;not_turned_beyond")
    list(GET change 0 from)
    list(GET change 1 to)
    string(FIND "${text}" "${${from}}" first)
    string(FIND "${text}" "${${from}}" last REVERSE)
    if(first EQUAL -1 OR NOT first EQUAL last)
      message(FATAL_ERROR "${original} is not as cmake/MendManifold.cmake expects. Look whether this release of Manifold \
still needs the change (docs/dependencies.md, test Compare.TheSameVolumeFromTheTargetReversed)")
    endif()
    string(REPLACE "${${from}}" "${${to}}" text "${text}")
  endforeach()
  file(WRITE ${mended_dir}/edge_op.new "${text}")
  file(COPY_FILE ${mended_dir}/edge_op.new ${mended_dir}/edge_op.cpp ONLY_IF_DIFFERENT)
  file(REMOVE ${mended_dir}/edge_op.new)

  get_target_property(sources manifold SOURCES)
  list(FILTER sources EXCLUDE REGEX "(^|/)edge_op\\.cpp$")
  set_target_properties(manifold PROPERTIES SOURCES "${sources};${mended_dir}/edge_op.cpp")
  target_include_directories(manifold PRIVATE ${source_dir}/src)
  target_compile_options(manifold PRIVATE -include ${PROJECT_SOURCE_DIR}/cmake/checked_malloc.h)
endfunction()
