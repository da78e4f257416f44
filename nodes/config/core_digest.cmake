# Writes OUT, the source of core_digest(), for the archive CORE.
file(SHA256 ${CORE} digest)
file(WRITE ${OUT}
     "#include \"nodes/config/core_digest.hpp\"\n\nstd::string_view rtg::config::core_digest() { return \"${digest}\"; }\n"
)
