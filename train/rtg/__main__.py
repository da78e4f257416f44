"""`python -m rtg ...`: the command of the user."""

import sys

from rtg.cli import main

sys.exit(main())
