"""What drives a body: the controller protocol and its kinds, and the one loop."""

from enpointe.controllers.feedforward import FeedForward as FeedForward
from enpointe.controllers.follow import Follow as Follow
from enpointe.controllers.gains import Gains as Gains
from enpointe.controllers.pd import PD as PD
from enpointe.controllers.perform import perform as perform
from enpointe.controllers.protocol import Body as Body
from enpointe.controllers.protocol import Command as Command
from enpointe.controllers.protocol import Controller as Controller
from enpointe.controllers.protocol import State as State
from enpointe.controllers.recording import Recording as Recording
from enpointe.controllers.springs import Springs as Springs
from enpointe.controllers.wholebody import WholeBody as WholeBody
