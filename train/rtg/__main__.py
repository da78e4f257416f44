"""`python -m rtg ...`: runs the command line of RTG."""

import sys

from rtg.cli import main

sys.exit(main())
