// The one file of rtg_headers and rtg_test_headers, which make precompiled headers for the others.
