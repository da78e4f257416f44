// The one file of the targets rtg_headers and rtg_test_headers, which make precompiled headers for the others.
