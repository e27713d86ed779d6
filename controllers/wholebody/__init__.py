"""Balance of the whole body: forces of the floor and accelerations of all joints, solved together.

A problem is built from named tasks and constraints and can be looked at before it is solved.
"""

from enpointe.controllers.wholebody.controller import DEFAULT_TASKS as DEFAULT_TASKS
from enpointe.controllers.wholebody.controller import STEPPING_TASKS as STEPPING_TASKS
from enpointe.controllers.wholebody.controller import WholeBody as WholeBody
from enpointe.controllers.wholebody.controller import Workload as Workload
from enpointe.controllers.wholebody.problem import WholeBodyProblem as WholeBodyProblem
